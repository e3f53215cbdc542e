// A textured mesh in React Three Fiber.
import { Canvas, useFrame } from "@react-three/fiber";
import { useBSMScene } from "bsm-decoder/react";
import { Suspense, useEffect, useRef } from "react";
import { createRoot } from "react-dom/client";
import type { Group } from "three";

function Ring({ url }: { url: string }) {
    const turning = useRef<Group>(null);
    const ring = useBSMScene(url);
    useFrame((_, seconds) => void turning.current?.rotateY(seconds));
    useEffect(() => void (document.title = "loaded"), [ring]);
    return (
        <group ref={turning}>
            <primitive object={ring} />
        </group>
    );
}

createRoot(document.getElementById("root")!).render(
    <Canvas camera={{ position: [0, 2, 4], fov: 35 }}>
        <color attach="background" args={["black"]} />
        <hemisphereLight args={["white", "gray", 3]} />
        <Suspense fallback={null}>
            <Ring url="/ring.bsm" />
        </Suspense>
    </Canvas>,
);

/** BSM streams in React Three Fiber. */
import { useLoader } from "@react-three/fiber";
import type { Group } from "three";
import { BSMLoader, BSMSceneLoader, type BSMGeometry } from "./three";

/** The geometry of a stream; the component waits for it (Suspense). */
export function useBSM(url: string, extend?: (loader: BSMLoader) => void): BSMGeometry {
    return useLoader<BSMGeometry, typeof BSMLoader>(BSMLoader, url, extend);
}

/** A stream as a group of meshes with materials and textures. */
export function useBSMScene(url: string, extend?: (loader: BSMSceneLoader) => void): Group {
    return useLoader<Group, typeof BSMSceneLoader>(BSMSceneLoader, url, extend);
}

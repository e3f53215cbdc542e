// A scene of glTF whose geometry is streams: bsm glb scene.glb -o public/ring.glb
import { Box3, HemisphereLight, PerspectiveCamera, Scene, Sphere, WebGLRenderer } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { GLTFBSMExtension } from "bsm-decoder/gltf";

const renderer = new WebGLRenderer({ antialias: true });
renderer.setSize(innerWidth, innerHeight);
document.getElementById("root")!.append(renderer.domElement);
const scene = new Scene();
const camera = new PerspectiveCamera(35, innerWidth / innerHeight, 0.01, 100);

const loader = new GLTFLoader().register((parser) => new GLTFBSMExtension(parser));
const gltf = await loader.loadAsync("/ring.glb");
scene.add(gltf.scene, new HemisphereLight(0xffffff, 0x888888, 3));

const { center, radius } = new Box3().setFromObject(gltf.scene).getBoundingSphere(new Sphere());
camera.position.set(center.x, center.y + 2 * radius, center.z + 4 * radius);
camera.lookAt(center);
renderer.setAnimationLoop((now) => {
    gltf.scene.rotation.y = now / 2000;
    renderer.render(scene, camera);
});
document.title = "loaded";

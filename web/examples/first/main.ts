import { AmbientLight, PerspectiveCamera, Scene, WebGLRenderer } from "three";
import { BSMLoader } from "bsm-decoder/three";
const [scene, camera, renderer] = [new Scene(), new PerspectiveCamera(50, innerWidth / innerHeight), new WebGLRenderer()];
camera.position.z = 4;
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);
scene.add(new AmbientLight("white", 3), await new BSMLoader().loadScene("/ring.bsm"));
renderer.render(scene, camera);

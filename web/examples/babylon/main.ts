// A scene of glTF whose geometry is streams, in Babylon.js: bsm glb scene.glb -o public/ring.glb
import { ArcRotateCamera } from "@babylonjs/core/Cameras/arcRotateCamera.js";
import { Engine } from "@babylonjs/core/Engines/engine.js";
import { HemisphericLight } from "@babylonjs/core/Lights/hemisphericLight.js";
import { AppendSceneAsync } from "@babylonjs/core/Loading/sceneLoader.js";
import { SceneLoaderFlags } from "@babylonjs/core/Loading/sceneLoaderFlags.js";
import { Color4 } from "@babylonjs/core/Maths/math.color.js";
import { Vector3 } from "@babylonjs/core/Maths/math.vector.js";
import { Scene } from "@babylonjs/core/scene.js";
import "@babylonjs/loaders/glTF/2.0/glTFLoader.js";
import { registerBSM } from "bsm-decoder/babylon";

const canvas = document.createElement("canvas");
canvas.style.cssText = "width: 100%; height: 100%";
document.getElementById("root")!.append(canvas);
const engine = new Engine(canvas, true);
const scene = new Scene(engine);
scene.clearColor = new Color4(0, 0, 0, 1);
new HemisphericLight("sky", Vector3.Up(), scene).intensity = 3;

SceneLoaderFlags.ShowLoadingScreen = false;
registerBSM();
await AppendSceneAsync("/ring.glb", scene);

const { min, max } = scene.getWorldExtends();
const size = Vector3.Distance(min, max);
const camera = new ArcRotateCamera("eye", 1, 1.1, 1.5 * size, min.add(max).scale(0.5), scene);
camera.minZ = size / 100;
engine.runRenderLoop(() => {
    camera.alpha = performance.now() / 2000;
    scene.render();
});
document.title = "loaded";

// What three.js shows of a moving GLB: node three.mjs FILE.glb RATE COUNT FOLDER_OF_NODE_MODULES, float64 to standard output.
import { readFileSync, writeSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [path, rate, count, modules] = process.argv.slice(2);
globalThis.self = globalThis;
const at = (name) => import(pathToFileURL(`${modules}/three/${name}`));
const THREE = await at("build/three.module.js");
const { GLTFLoader } = await at("examples/jsm/loaders/GLTFLoader.js");

const file = readFileSync(path);
const data = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
const gltf = await new Promise((resolve, reject) => new GLTFLoader().parse(data, "", resolve, reject));
const mixer = new THREE.AnimationMixer(gltf.scene);
mixer.clipAction(gltf.animations[0]).setLoop(THREE.LoopOnce).play().clampWhenFinished = true;
const start = Math.min(...gltf.animations[0].tracks.map(({ times }) => times[0]));
const point = new THREE.Vector3();
for (let frame = 0; frame < Number(count); frame++) {
    mixer.setTime(start + frame / Number(rate));
    gltf.scene.updateMatrixWorld(true);
    const numbers = [];
    gltf.scene.traverse((node) => {
        if (!node.isMesh) return;
        for (let vertex = 0; vertex < node.geometry.attributes.position.count; vertex++) {
            node.getVertexPosition(vertex, point); // morph targets and bones
            numbers.push(...point.applyMatrix4(node.matrixWorld).toArray());
        }
    });
    writeSync(1, new Uint8Array(Float64Array.from(numbers).buffer));
}

// SPDX-License-Identifier: MIT
// Loads glTF files with three.js and plays their animations: `node load.mjs FILE...|FOLDER`. Every track has to find its
// node, no joint may get lost, and every skinned figure has to stand on the floor while it plays.
import { readFileSync } from "node:fs";
import { gltfFiles, skipWithout } from "./files.mjs";

// What three.js expects of a browser.
globalThis.self ??= globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const THREE = await skipWithout("three");
const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");

const loader = new GLTFLoader();
let failed = 0;
function check(good, file, what) {
    if (!good) {
        console.log(`${file}: ${what}`);
        ++failed;
    }
}

for (const file of gltfFiles(process.argv.slice(2))) {
    const bytes = readFileSync(file);
    // A .gltf comes with a buffer beside it, which three would fetch over the network: give it inside the text.
    let content = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
    if (file.endsWith(".gltf")) {
        const json = JSON.parse(bytes.toString("utf8"));
        for (const buffer of json.buffers ?? []) {
            const path = new URL(buffer.uri, `file://${new URL(file, `file://${process.cwd()}/`).pathname}`);
            buffer.uri = "data:application/octet-stream;base64," + readFileSync(path).toString("base64");
        }
        content = JSON.stringify(json);
    }
    const gltf = await new Promise((resolve, reject) => loader.parse(content, "", resolve, reject));
    const skinned = [];
    gltf.scene.traverse((object) => object.isSkinnedMesh && skinned.push(object));
    check(gltf.animations.length > 0, file, "no animation");
    for (const clip of gltf.animations) {
        for (const track of clip.tracks) {
            const { nodeName } = THREE.PropertyBinding.parseTrackName(track.name);
            check(THREE.PropertyBinding.findNode(gltf.scene, nodeName), file, `track ${track.name} finds no node`);
        }
        check(clip.validate(), file, `clip ${clip.name} is not valid`);
        check(Array.isArray(clip.userData?.puppetri?.events ?? gltf.parser.json.animations[0].extras.puppetri.events), file,
            "no events");
        const mixer = new THREE.AnimationMixer(gltf.scene);
        mixer.clipAction(clip).play();
        for (let i = 0; i <= 10; ++i) {
            mixer.setTime((clip.duration * i) / 10.001);
            gltf.scene.updateMatrixWorld(true);
            for (const mesh of skinned) {
                mesh.computeBoundingBox();
                const box = mesh.boundingBox.clone().applyMatrix4(mesh.matrixWorld);
                const good = [box.min, box.max].every((v) => [v.x, v.y, v.z].every(Number.isFinite));
                check(good, file, `${clip.name}: ${mesh.name} is nowhere`);
                check(box.min.y > -0.2 && box.max.y < 4, file,
                    `${clip.name}: ${mesh.name} is off the floor at ${(clip.duration * i) / 10} s: ${box.min.y}`);
            }
        }
        mixer.stopAllAction();
    }
    console.log(`${file}: ${gltf.animations.length} animations, ${skinned.length} skinned meshes, ` +
        `${gltf.animations.reduce((sum, clip) => sum + clip.tracks.length, 0)} tracks`);
}
process.exit(failed === 0 ? 0 : 1);

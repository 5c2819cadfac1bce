// Checks that three.js plays the animation in GLB with the positions of the point cache PC2 of the same edit.
//
//   npm install three
//   node animation.mjs GLB PC2 FPS
//
// `pliant animate FILE --edit EDIT.json --output GLB`, and again with `PC2`. Ten frames are compared, vertex by vertex
// in the file's order. Prints the largest distance as a share of the diagonal, and ends with status 1 above 1e-5.

import { readFileSync } from 'node:fs';
import { THREE, opened } from './three.mjs';

const [glb, pc2, fps] = process.argv.slice(2);
if (!fps) {
    console.error('node animation.mjs GLB PC2 FPS');
    process.exit(2);
}

const cache = readFileSync(pc2);
const [count, frames] = [cache.readInt32LE(16), cache.readInt32LE(28)];
const wanted = (frame, vertex) =>
    new THREE.Vector3(...[0, 1, 2].map((k) => cache.readFloatLE(32 + 12 * (frame * count + vertex) + 4 * k)));

const gltf = await opened(readFileSync(glb));
const mixer = new THREE.AnimationMixer(gltf.scene);
mixer.clipAction(gltf.animations.at(-1)).setLoop(THREE.LoopOnce).play();
mixer.clipAction(gltf.animations.at(-1)).clampWhenFinished = true;
const meshes = [];
gltf.scene.traverse((object) => object.isMesh && meshes.push(object));

let [largest, found] = [0, 0];
const bounds = new THREE.Box3();
for (let sample = 0; sample < 10; sample += 1) {
    const frame = Math.round((sample * (frames - 1)) / 9);
    mixer.setTime(frame / Number(fps));
    gltf.scene.updateMatrixWorld(true);
    found = 0;
    for (const mesh of meshes) {
        for (let vertex = 0; vertex < mesh.geometry.attributes.position.count; vertex += 1) {
            const place = mesh.localToWorld(mesh.getVertexPosition(vertex, new THREE.Vector3()));
            bounds.expandByPoint(place);
            largest = Math.max(largest, place.distanceTo(wanted(frame, found)));
            found += 1;
        }
    }
}
const share = largest / bounds.getSize(new THREE.Vector3()).length();
console.log(`${found} of ${count} vertices, ten of ${frames} frames: ${share.toExponential(1)} of the diagonal`);
process.exit(found === count && share <= 1e-5 ? 0 : 1);

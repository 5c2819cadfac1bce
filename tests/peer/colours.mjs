// Checks that three.js reads the same vertex colours of two files of the same surface: GLB, whose colours are linear and
// have 16 bits, and PLY, whose colours are bytes of sRGB.
//
//   npm install three
//   node colours.mjs GLB PLY
//
// Save the same project, or run the same `pliant flow`, to both. Vertices are matched by their positions. Prints the
// number of colours and the largest difference in bytes of sRGB, and ends with status 1 above 1, or if a vertex of the
// GLB is not in the PLY.

import { readFileSync } from 'node:fs';
import { THREE, load, opened } from './three.mjs';

const [glb, ply] = process.argv.slice(2);
if (!ply) {
    console.error('node colours.mjs GLB PLY');
    process.exit(2);
}
const { PLYLoader } = await load('examples/jsm/loaders/PLYLoader.js');

const bytes = readFileSync(ply);
const other = new PLYLoader().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
const gltf = await opened(readFileSync(glb));
gltf.scene.updateMatrixWorld(true);
const meshes = [];
gltf.scene.traverse((object) => object.isMesh && meshes.push(object));

// Both have positions of single precision; a node's matrix may move the last digit.
const size = new THREE.Box3().setFromBufferAttribute(other.attributes.position).getSize(new THREE.Vector3()).length();
const key = (place) => place.toArray().map((value) => Math.round((value / size) * 1e5)).join();
const near = (place) => {
    const keys = [];
    for (const x of [-4e-6, 4e-6])
        for (const y of [-4e-6, 4e-6])
            for (const z of [-4e-6, 4e-6])
                keys.push(key(place.clone().add(new THREE.Vector3(x, y, z).multiplyScalar(size))));
    return new Set(keys);
};
const srgb = (attribute, vertex) =>
    new THREE.Color()
        .fromBufferAttribute(attribute, vertex)
        .convertLinearToSRGB()
        .toArray()
        .map((value) => 255 * value);

const colours = new Map();
for (let vertex = 0; vertex < other.attributes.position.count; vertex += 1) {
    const place = new THREE.Vector3().fromBufferAttribute(other.attributes.position, vertex);
    for (const name of near(place)) {
        if (!colours.has(name)) colours.set(name, []);
        colours.get(name).push(srgb(other.attributes.color, vertex));
    }
}

let [largest, found, missing] = [0, 0, 0];
const kinds = new Set();
for (const mesh of meshes) {
    const { position, color } = mesh.geometry.attributes;
    for (let vertex = 0; vertex < position.count; vertex += 1) {
        const place = mesh.localToWorld(new THREE.Vector3().fromBufferAttribute(position, vertex));
        const there = colours.get(key(place));
        if (!color || !there) {
            missing += 1;
            continue;
        }
        const here = srgb(color, vertex);
        // Where vertices coincide the nearest colour counts.
        const differences = there.map((one) => Math.max(...one.map((value, k) => Math.abs(value - here[k]))));
        largest = Math.max(largest, Math.min(...differences));
        kinds.add(here.map(Math.round).join());
        found += 1;
    }
}
console.log(
    `${found} vertices, ${kinds.size} colours, ${missing} missing: ${largest.toFixed(2)} of 255 apart at most`,
);
process.exit(missing === 0 && found > 0 && kinds.size > 1 && largest <= 1 ? 0 : 1);

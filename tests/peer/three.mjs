// three.js without a browser, for the checks beside it: `npm install three`; set NODE_PATH if it is elsewhere.

import { createRequire } from 'node:module';
import { dirname, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

export const root = dirname(dirname(createRequire(import.meta.url).resolve('three')));
export const load = (path) => import(pathToFileURL(resolve(root, path)));
globalThis.self = globalThis;
globalThis.ProgressEvent ??= class {};
export const THREE = await load('build/three.module.js');
export const { GLTFLoader } = await load('examples/jsm/loaders/GLTFLoader.js');

// The same GLB without materials and images: node has no pictures.
function bare(bytes) {
    const length = bytes.readUInt32LE(12);
    const json = JSON.parse(bytes.subarray(20, 20 + length).toString());
    for (const name of ['materials', 'textures', 'images', 'samplers']) delete json[name];
    for (const mesh of json.meshes) for (const primitive of mesh.primitives) delete primitive.material;
    let text = Buffer.from(JSON.stringify(json));
    text = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
    const rest = bytes.subarray(20 + length);
    const head = Buffer.alloc(20);
    bytes.copy(head, 0, 0, 20);
    head.writeUInt32LE(20 + text.length + rest.length, 8);
    head.writeUInt32LE(text.length, 12);
    const all = Buffer.concat([head, text, rest]);
    return all.buffer.slice(all.byteOffset, all.byteOffset + all.length);
}

// What three.js reads of a GLB, but for materials.
export const opened = (bytes) =>
    new Promise((done, failed) => new GLTFLoader().parse(bare(bytes), '', done, failed));

// Checks that three.js' loader finds as much in OUT as in IN.
//
//   npm install three
//   node counts.mjs IN OUT
//
// Prints vertices, triangles, materials, images, skins, animations and morph targets of both, and ends with status 1
// if they differ. Images are counted and not decoded: node has no pictures.

import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { basename, dirname, resolve } from 'node:path';
import { GLTFLoader, THREE, load, root } from './three.mjs';

const require = createRequire(import.meta.url);
const { MeshoptDecoder } = await load('examples/jsm/libs/meshopt_decoder.module.js');

// Draco by three.js' own decoder, without the browser's workers that its loader needs.
const dracoFolder = resolve(root, 'examples/jsm/libs/draco/gltf');
const dracoText = readFileSync(resolve(dracoFolder, 'draco_decoder.js'), 'utf8');
const script = new Function('require', '__filename', '__dirname', `${dracoText}; return DracoDecoderModule;`);
const draco = await script(require, resolve(dracoFolder, 'draco_decoder.js'), dracoFolder)();
const dracoLoader = {
    preload() {},
    decodeDracoFile(data, done, ids) {
        const bytes = new Int8Array(data);
        const decoder = new draco.Decoder();
        const mesh = new draco.Mesh();
        const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
        if (!status.ok()) {
            throw new Error(status.error_msg());
        }
        const geometry = new THREE.BufferGeometry();
        for (const [name, id] of Object.entries(ids)) {
            const attribute = decoder.GetAttributeByUniqueId(mesh, id);
            const numbers = new draco.DracoFloat32Array();
            decoder.GetAttributeFloatForAllPoints(mesh, attribute, numbers);
            const array = Float32Array.from({ length: numbers.size() }, (_, k) => numbers.GetValue(k));
            geometry.setAttribute(name, new THREE.BufferAttribute(array, attribute.num_components()));
        }
        const corners = new draco.DracoInt32Array();
        const index = [];
        for (let face = 0; face < mesh.num_faces(); face += 1) {
            decoder.GetFaceFromMesh(mesh, face, corners);
            index.push(corners.GetValue(0), corners.GetValue(1), corners.GetValue(2));
        }
        geometry.setIndex(index);
        done(geometry);
    },
};

async function counts(path) {
    const folder = dirname(resolve(path));
    const manager = new THREE.LoadingManager();
    const loader = new GLTFLoader(manager);
    loader.setMeshoptDecoder(MeshoptDecoder);
    loader.setDRACOLoader(dracoLoader);
    // There are no pictures: an empty texture replaces each.
    loader.register((parser) => {
        parser.loadTextureImage = async () => new THREE.Texture();
        return { name: 'no-pictures' };
    });
    THREE.FileLoader.prototype.load = function (url, done, _, failed) {
        try {
            const bytes = url.startsWith('data:')
                ? Buffer.from(url.slice(url.indexOf(',') + 1), 'base64')
                : readFileSync(resolve(folder, decodeURIComponent(url)));
            done(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
        } catch (error) {
            failed(error);
        }
    };
    const bytes = readFileSync(path);
    const content = basename(path).endsWith('.gltf') ? bytes.toString() : bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
    const gltf = await loader.parseAsync(content, '');
    const found = { vertices: 0, triangles: 0, targets: 0, nodes: 0, animations: gltf.animations.length };
    for (const scene of gltf.scenes) {
        scene.traverse((object) => {
            found.nodes += 1;
            const geometry = object.geometry;
            if (geometry) {
                found.vertices += geometry.attributes.position?.count ?? 0;
                found.triangles += (geometry.index?.count ?? geometry.attributes.position?.count ?? 0) / 3;
                found.targets += geometry.morphAttributes.position?.length ?? 0;
            }
        });
    }
    const json = gltf.parser.json;
    for (const key of ['materials', 'images', 'skins']) {
        found[key] = json[key]?.length ?? 0;
    }
    return found;
}

const [input, output] = process.argv.slice(2);
if (!output) {
    console.error('node counts.mjs IN OUT');
    process.exit(2);
}
const [before, after] = [await counts(input), await counts(output)];
const is_same = JSON.stringify(before) === JSON.stringify(after);
console.log(`${is_same ? 'same' : 'DIFFERENT'} ${JSON.stringify(before)}${is_same ? '' : ` ${JSON.stringify(after)}`}`);
process.exit(is_same ? 0 : 1);

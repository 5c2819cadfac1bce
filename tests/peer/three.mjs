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

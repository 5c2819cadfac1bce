// The picture of FILE by three.js under the studio's light, with the camera of `pliant render` for REST.
//
//   npm install three puppeteer-core
//   CHROMIUM=/usr/bin/chromium node pictures.mjs REST FILE OUT.png [linear]
//   pliant render REST --output OURS.png --size 900x900 --shading material --transparent
//
// Lamps, exposure and key are read from our shaders, so that only a surface's response to light differs. `linear` adds
// light where one object is seen through another, like Pliant; three.js by itself mixes the screen's numbers.

import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import puppeteer from 'puppeteer-core';

const SIDE_PX = 900;
const [rest, file, output, blending] = process.argv.slice(2);
const require = createRequire(import.meta.url);
const three = dirname(dirname(require.resolve('three')));
const shaders = resolve(dirname(fileURLToPath(import.meta.url)), '../../shaders');
const shader = (name) => readFileSync(join(shaders, name), 'utf8');

/// The numbers in a piece of WGSL, without those in a type's name.
const numbers = (text) => [...text.replace(/vec\df/g, '').matchAll(/-?\d+\.\d+/g)].map((match) => Number(match[0]));
const lines = (text, start) => text.split('\n').filter((line) => line.trim().startsWith(start)).map(numbers);
const environment = shader('environment.wgsl');
const studio = {
    lamps: lines(environment, 'light += lamp('),
    wall: lines(environment, 'let wall')[0],
    floor: lines(environment, 'let floor')[0],
    key: lines(shader('lib/reflectance.wgsl'), 'const KEY:')[0],
    keyColour: lines(shader('lib/reflectance.wgsl'), 'const KEY_COLOUR')[0],
    exposure: lines(shader('material.wgsl'), 'const EXPOSURE')[0][0],
};

/// Runs in the browser: it draws, and then sets `window.done`.
async function draw({ studio, side, rest, file, linear }) {
    const THREE = await import('three');
    const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');
    const V = (x, y, z) => new THREE.Vector3(x, y, z);
    const open = (url) => new GLTFLoader().loadAsync(url);
    const canvas = document.body.appendChild(document.createElement('canvas'));
    const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    renderer.setSize(side, side, false);
    renderer.setClearColor(0, 0);
    renderer.toneMapping = THREE.NeutralToneMapping;

    // The eye frames a shape like the camera of crates/editor, and is as much farther away as that of `render`.
    const [fov, yaw, pitch, margin, room] = [(Math.PI / 4) * 0.9, 0.6, 0.35, 1.15, 1.2];
    const back = V(Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch));
    const right = V(0, 1, 0).cross(back).normalize();
    const up = back.clone().cross(right);
    const toView = (p) => V(p.dot(right), p.dot(up), p.dot(back));
    const toWorld = (p) => V().addScaledVector(right, p.x).addScaledVector(up, p.y).addScaledVector(back, p.z);
    const seen = [];
    const framed = (await open(rest)).scene;
    framed.updateMatrixWorld(true);
    framed.traverse((node) => {
        const positions = node.geometry?.attributes.position;
        for (let i = 0; i < (positions?.count ?? 0); i++) {
            seen.push(toView(V().fromBufferAttribute(positions, i).applyMatrix4(node.matrixWorld)));
        }
    });
    const slope = Math.tan(fov / 2) / margin;
    const centre = new THREE.Box3().setFromPoints(seen).getCenter(V());
    const away = (p) => p.z - centre.z + Math.max(Math.abs(p.x - centre.x), Math.abs(p.y - centre.y)) / slope;
    const distance = () => seen.reduce((most, p) => Math.max(most, away(p)), 0);
    for (let round = 0; round < 3; round++) {
        const from = distance();
        const bounds = new THREE.Box2();
        seen.forEach((p) => {
            const depth = from - (p.z - centre.z);
            bounds.expandByPoint({ x: (p.x - centre.x) / depth, y: (p.y - centre.y) / depth });
        });
        centre.x += 0.5 * from * (bounds.min.x + bounds.max.x);
        centre.y += 0.5 * from * (bounds.min.y + bounds.max.y);
    }
    const eye = distance() * room;
    const camera = new THREE.PerspectiveCamera((fov * 180) / Math.PI, 1, eye * 0.01, eye * 10);
    camera.position.copy(toWorld(centre)).addScaledVector(back, eye);
    camera.lookAt(toWorld(centre));

    const smooth = (a, b, x) => {
        const t = Math.min(1, Math.max(0, (x - a) / (b - a)));
        return t * t * (3 - 2 * t);
    };
    const light = (d) => {
        const [r, g, b, toR, toG, toB, from, to] = d.y > 0 ? studio.wall : studio.floor;
        const share = smooth(from, to, d.y);
        const sum = [r + (toR - r) * share, g + (toG - g) * share, b + (toB - b) * share];
        for (const [x, y, z, width, height, softness, ...colour] of studio.lamps) {
            const towards = V(x, y, z).normalize();
            const before = d.dot(towards);
            if (before <= 0.02) continue;
            const across = V(0, 1, 0).cross(towards).normalize();
            const at = [Math.abs(d.dot(across)), Math.abs(d.dot(towards.clone().cross(across)))].map((x) => x / before);
            const inside = [width, height].map((half, i) => smooth(half + softness, half - softness, at[i]));
            colour.forEach((channel, i) => (sum[i] += channel * inside[0] * inside[1]));
        }
        return [...sum, 1];
    };
    const [w, h] = [1024, 512];
    const sky = new Float32Array(4 * w * h);
    for (let place = 0; place < w * h; place++) {
        const turn = (((place % w) + 0.5) / w - 0.5) * 2 * Math.PI;
        const rise = ((Math.floor(place / w) + 0.5) / h - 0.5) * Math.PI;
        const direction = V(Math.cos(rise) * Math.cos(turn), Math.sin(rise), Math.cos(rise) * Math.sin(turn));
        sky.set(light(toView(direction)), 4 * place);
    }
    const around = new THREE.DataTexture(sky, w, h, THREE.RGBAFormat, THREE.FloatType);
    around.mapping = THREE.EquirectangularReflectionMapping;
    around.minFilter = around.magFilter = THREE.LinearFilter;
    around.needsUpdate = true;
    const scene = new THREE.Scene();
    scene.environment = new THREE.PMREMGenerator(renderer).fromEquirectangular(around).texture;
    scene.environmentIntensity = studio.exposure;
    const key = new THREE.DirectionalLight(new THREE.Color(...studio.keyColour), studio.exposure);
    key.position.copy(toWorld(V(...studio.key)));
    scene.add(key, (await open(file)).scene);
    let show = () => renderer.render(scene, camera);
    if (linear) {
        const { EffectComposer } = await import('three/addons/postprocessing/EffectComposer.js');
        const { RenderPass } = await import('three/addons/postprocessing/RenderPass.js');
        const { OutputPass } = await import('three/addons/postprocessing/OutputPass.js');
        const options = { type: THREE.HalfFloatType, samples: 4 };
        const composer = new EffectComposer(renderer, new THREE.WebGLRenderTarget(side, side, options));
        composer.addPass(new RenderPass(scene, camera));
        composer.addPass(new OutputPass());
        show = () => composer.render();
    }
    show();
    return canvas.toDataURL();
}

const imports = { three: '/three/build/three.module.js', 'three/addons/': '/three/examples/jsm/' };
const page = `<script type="importmap">${JSON.stringify({ imports })}</script><body></body>`;
const folders = { three, rest: dirname(resolve(rest)), file: dirname(resolve(file)) };
const server = createServer((request, response) => {
    const [, folder, ...path] = decodeURIComponent(request.url).split('/');
    const found = folders[folder] && join(folders[folder], ...path);
    const type = found?.endsWith('.js') ? 'text/javascript' : found ? 'application/octet-stream' : 'text/html';
    response.writeHead(found && !existsSync(found) ? 404 : 200, { 'content-type': type });
    response.end(found ? existsSync(found) && readFileSync(found) : page);
});
await new Promise((ready) => server.listen(0, ready));
const browser = await puppeteer.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
});
const tab = await browser.newPage();
await tab.goto(`http://localhost:${server.address().port}/`);
const [restUrl, fileUrl] = [`/rest/${basename(rest)}`, `/file/${basename(file)}`];
const job = { studio, side: SIDE_PX, rest: restUrl, file: fileUrl, linear: blending === 'linear' };
const url = await tab.evaluate(draw, job);
writeFileSync(output, Buffer.from(url.split(',')[1], 'base64'));
await browser.close();
server.close();

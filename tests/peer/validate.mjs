// The findings of the Khronos validator in OUT that are not in IN.
//
//   npm install gltf-validator
//   node validate.mjs IN OUT
//
// Prints each new finding as one line and ends with status 1 if there are any, 0 if there are none. A finding is
// known if IN has as many of the same code at the same place; places that the edit added (a new accessor, a cloned
// mesh) count as new. Set NODE_PATH if the package is elsewhere.

import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { dirname, basename, resolve } from 'node:path';

const require = createRequire(import.meta.url);
const validator = require('gltf-validator');

async function findings(path) {
    const folder = dirname(resolve(path));
    const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
        uri: basename(path),
        maxIssues: 0,
        externalResourceFunction: async (uri) => new Uint8Array(readFileSync(resolve(folder, decodeURIComponent(uri)))),
    });
    return report;
}

const [input, output] = process.argv.slice(2);
if (!output) {
    console.error('node validate.mjs IN OUT');
    process.exit(2);
}
const [before, after] = await Promise.all([findings(input), findings(output)]);
const key = (message) => `${message.code} ${message.pointer ?? message.offset ?? ''}`;
const known = new Map();
for (const message of before.issues.messages) {
    known.set(key(message), (known.get(key(message)) ?? 0) + 1);
}
let fresh = 0;
for (const message of after.issues.messages) {
    const left = known.get(key(message)) ?? 0;
    if (left > 0) {
        known.set(key(message), left - 1);
        continue;
    }
    fresh += 1;
    const severity = ['error', 'warning', 'information', 'hint'][message.severity];
    console.log(`${severity} ${message.code} ${message.pointer ?? ''}: ${message.message}`);
}
process.exit(fresh > 0 ? 1 : 0);

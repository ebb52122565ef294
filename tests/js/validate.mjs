// SPDX-License-Identifier: MIT
// Runs the Khronos validator over glTF files: `node validate.mjs FILE...` or `node validate.mjs FOLDER`. Any error or
// warning fails; notes below that are shown.
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { gltfFiles, skipWithout } from "./files.mjs";

const validator = await skipWithout("gltf-validator");
let failed = 0;
for (const file of gltfFiles(process.argv.slice(2))) {
    const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {
        uri: file,
        maxIssues: 50,
        externalResourceFunction: async (uri) => new Uint8Array(readFileSync(join(dirname(file), decodeURIComponent(uri)))),
    });
    const { numErrors, numWarnings, numInfos, numHints, messages } = report.issues;
    console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ${numHints} hints`);
    for (const { code, message, pointer } of messages) {
        console.log(`  ${code} ${pointer ?? ""}: ${message}`);
    }
    failed += numErrors + numWarnings;
}
process.exit(failed === 0 ? 0 : 1);

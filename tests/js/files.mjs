// SPDX-License-Identifier: MIT
// What the scripts here share: which files to read, and how to bow out when a package is not installed.
import { readdirSync, statSync } from "node:fs";
import { join } from "node:path";

// ctest counts this exit code as "skipped".
const SKIPPED = 77;

export async function skipWithout(name) {
    try {
        const module = await import(name);
        return module.default ?? module;
    } catch (problem) {
        if (problem.code !== "ERR_MODULE_NOT_FOUND") {
            throw problem;
        }
        console.log(`skipped: the package ${name} is not installed`);
        process.exit(SKIPPED);
    }
}

// Folders stand for the .glb and .gltf files in them. None at all is a failure: then nothing would be tested.
export function gltfFiles(paths) {
    const files = paths.flatMap((path) =>
        statSync(path).isDirectory()
            ? readdirSync(path).filter((name) => /\.(glb|gltf)$/.test(name)).map((name) => join(path, name))
            : [path]);
    if (files.length === 0) {
        console.error("no files to read");
        process.exit(1);
    }
    return files;
}

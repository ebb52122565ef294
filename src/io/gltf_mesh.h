// SPDX-License-Identifier: MIT
// Meshes and skins of a glTF file.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "gltf_buffer.h"
#include "puppetri/figure/mesh.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::io {

struct GltfPrimitive {
    int indices = 0, positions = 0, normals = 0;
    int joints = -1, weights = -1;  // accessors; -1 for a rigid mesh
    int uvs = -1;                   // accessor; -1 where there are none
    int material = -1;              // of the file
};

struct GltfMesh {
    std::string name;
    std::vector<GltfPrimitive> primitives;
};

struct GltfImageOut {
    std::string name, mime_type;
    int view = 0;
};

struct GltfTextureOut {
    int image = 0, sampler = 0;
    bool operator==(const GltfTextureOut&) const = default;
};

struct GltfSamplerOut {
    int wrap_s = 10497, wrap_t = 10497;
    bool smooth = true;
    bool operator==(const GltfSamplerOut&) const = default;
};

struct GltfMeshes {
    std::vector<GltfMesh> meshes;
    std::vector<figure::Material> materials;  // their textures are those of the file
    std::vector<GltfTextureOut> textures;
    std::vector<GltfSamplerOut> samplers;
    std::vector<GltfImageOut> images;
    std::map<std::string, int> image_of;  // by bytes: a picture is written once
};

// Gives the mesh's index in the file, or -1 where it has no triangles. Needs consistent array
// sizes.
int add_mesh(GltfMeshes& all, GltfBuffer& buffer, const std::string& name,
             const figure::Mesh& mesh);

// The accessor of the inverse bind matrices of the skeleton's rest pose.
int add_inverse_bind_matrices(GltfBuffer& buffer, const figure::Skeleton& skeleton);

void write_meshes(JsonWriter& json, const GltfMeshes& all);
void write_materials(JsonWriter& json, const GltfMeshes& all);
void write_textures(JsonWriter& json, const GltfMeshes& all);
void write_samplers(JsonWriter& json, const GltfMeshes& all);
void write_images(JsonWriter& json, const GltfMeshes& all);

}  // namespace puppetri::io

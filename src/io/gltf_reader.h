// SPDX-License-Identifier: MIT
// From the JSON of a glTF file to a GltfDocument: every property is checked where it is read, every
// defect is told with the element it belongs to, and reading goes on so that all are found.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "defects.h"
#include "gltf_container.h"
#include "puppetri/io/gltf_document.h"

namespace puppetri::io {

class GltfReader {
 public:
    using Json = nlohmann::json;

    GltfReader(const std::string& path, scene::FileSource* files) : path_(path), files_(files) {}

    Checked<GltfDocument> read(std::string_view bytes);

 private:
    // ---- telling ----
    void error(const char* code, std::string element, std::string message, std::string remedy);
    void bad(const std::string& element, std::string message);
    void note(const char* code, const std::string& element, std::string message,
              std::string remedy);

    // ---- properties: a wrong one is told and gives the default ----
    const Json& list(const Json& owner, const char* name, const std::string& element);
    const Json* object(const Json& owner, const char* name, const std::string& element);
    std::string text(const Json& owner, const char* name, const std::string& element);
    // Whole numbers in [0, limit).
    std::optional<std::uint64_t> whole(const Json& owner, const char* name,
                                       const std::string& element, std::uint64_t limit);
    std::uint32_t index(const Json& owner, const char* name, const std::string& element,
                        std::size_t limit, const char* of);
    double number(const Json& owner, const char* name, const std::string& element,
                  double otherwise);
    bool numbers(const Json& owner, const char* name, const std::string& element, double* out,
                 std::size_t count);
    bool truth(const Json& owner, const char* name, const std::string& element);

    // ---- parts of the file ----
    bool read_json(std::string_view text);
    void read_asset();
    void read_buffers(const GltfContainer& parts);
    void read_views();
    void read_accessors();
    void read_sparse(const Json& accessor, const std::string& element,
                     GltfDocument::Accessor& made);
    void read_images();
    void read_textures();
    void read_materials();
    std::uint32_t texture_of(const Json& owner, const char* name, const std::string& element);
    void read_meshes();
    GltfPrimitiveIn read_primitive(const Json& primitive, const std::string& element);
    void check_primitive(const GltfPrimitiveIn& primitive, const std::string& element);
    void read_nodes();
    void read_transform(const Json& node, const std::string& element, GltfNode& made);
    void check_forest();
    void read_roots();
    void read_skins();
    void check_skinned_nodes();
    void read_animations();
    void read_channel(const Json& channel, const Json& samplers, const std::string& element,
                      GltfAnimationIn& made);
    void read_humanoid();
    void read_bones(const Json& bones, bool version_0);
    void add_bone(const std::string& bone, std::uint32_t node, const std::string& element);
    void warn_of_lines();

    std::optional<std::string> bytes_of_uri(const std::string& uri, const std::string& element,
                                            std::string& media);
    // An accessor as somebody wants to use it. Tells what does not fit; gives whether all does.
    // What is decoded counts against the budget.
    bool use(std::uint32_t accessor, const std::string& element, const char* as,
             std::initializer_list<std::uint32_t> components,
             std::initializer_list<std::uint32_t> types, bool normalized_integers = false);
    bool view_holds(std::uint32_t view, std::uint64_t offset, std::uint64_t stride,
                    std::uint64_t size, std::uint64_t count, const std::string& element);

    std::string path_;
    scene::FileSource* files_ = nullptr;
    Json root_;
    GltfDocument doc_;
    Defects defects_;
    std::uint64_t decoded_ = 0;
    std::vector<std::uint8_t> finite_;       // by accessor: 1 when looked through already
    std::vector<std::uint32_t> most_joint_;  // by mesh: the largest joint that has a weight
};

// "node 3".
inline std::string gltf_element(const char* kind, std::size_t number) {
    return std::string(kind) + " " + std::to_string(number);
}

// Bytes of one component; 0 for a type that glTF does not know.
std::uint32_t gltf_component_size(std::uint32_t component_type);

}  // namespace puppetri::io

// SPDX-License-Identifier: MIT
// Properties of JSON, and what all else stands on: buffers, views, accessors, images.
#include "gltf_reader.h"

#include <algorithm>
#include <cmath>

#include "puppetri/scene/file_source.h"

namespace puppetri::io {
namespace {

using Json = GltfReader::Json;

constexpr const char* kDamaged = "the file is damaged or its writer is at fault: export it again";
constexpr std::uint64_t kMostElements = 1u << 20, kMostDepth = 64, kMostValues = 1u << 22,
                        kMostBytes = std::uint64_t{1} << 32;

const Json& no_list() {
    static const Json empty = Json::array();
    return empty;
}

// Whether the text may be given to the parser: nested and long only as far as memory allows.
bool modest(std::string_view text) {
    std::uint64_t depth = 0, values = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\') {
                ++i;
            } else if (c == '"') {
                quoted = false;
            }
        } else if (c == '"') {
            quoted = true;
        } else if (c == '[' || c == '{') {
            ++values;
            if (++depth > kMostDepth) {
                return false;
            }
        } else if (c == ']' || c == '}') {
            depth -= depth > 0 ? 1 : 0;
        } else if (c == ',') {
            ++values;
        }
    }
    return values <= kMostValues;
}

SourceSpan place_of(const std::string& path, std::string_view text, std::size_t byte) {
    SourceSpan where{path, 1, 1, 1};
    for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
        if (text[i] == '\n') {
            ++where.line;
            where.column = 1;
        } else if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) {
            ++where.column;
        }
    }
    return where;
}

}  // namespace

void GltfReader::error(const char* code, std::string element, std::string message,
                       std::string remedy) {
    defects_.error(code, {path_, 0, 0, 1}, std::move(element), std::move(message),
                   std::move(remedy));
}

void GltfReader::bad(const std::string& element, std::string message) {
    error("bad-gltf", element, std::move(message), kDamaged);
}

void GltfReader::note(const char* code, const std::string& element, std::string message,
                      std::string remedy) {
    doc_.notes.push_back({Severity::kWarning,
                          code,
                          {path_, 0, 0, 1},
                          element,
                          std::move(message),
                          std::move(remedy)});
}

const Json& GltfReader::list(const Json& owner, const char* name, const std::string& element) {
    const auto at = owner.find(name);
    if (at == owner.end()) {
        return no_list();
    }
    if (!at->is_array()) {
        bad(element, std::string(name) + " is not a list");
        return no_list();
    }
    if (at->size() > kMostElements) {
        error("too-large", element,
              std::string(name) + " has " + std::to_string(at->size()) + " entries",
              "make it smaller: at most " + std::to_string(kMostElements) + " are read");
        return no_list();
    }
    return *at;
}

const Json* GltfReader::object(const Json& owner, const char* name, const std::string& element) {
    const auto at = owner.find(name);
    if (at == owner.end()) {
        return nullptr;
    }
    if (!at->is_object()) {
        bad(element, std::string(name) + " is not an object");
        return nullptr;
    }
    return &*at;
}

std::string GltfReader::text(const Json& owner, const char* name, const std::string& element) {
    const auto at = owner.find(name);
    if (at == owner.end()) {
        return {};
    }
    if (!at->is_string()) {
        bad(element, std::string(name) + " is not a text");
        return {};
    }
    return at->get<std::string>();
}

std::optional<std::uint64_t> GltfReader::whole(const Json& owner, const char* name,
                                               const std::string& element, std::uint64_t limit) {
    const auto at = owner.find(name);
    if (at == owner.end()) {
        return std::nullopt;
    }
    // Some writers say 3.0.
    const bool good =
        at->is_number_unsigned() ||
        (at->is_number_float() && at->get<double>() >= 0 && at->get<double>() < 9e15 &&
         at->get<double>() == std::floor(at->get<double>()));
    const std::uint64_t value = !good ? 0
                                : at->is_number_unsigned()
                                    ? at->get<std::uint64_t>()
                                    : static_cast<std::uint64_t>(at->get<double>());
    if (!good || value >= limit) {
        bad(element, std::string(name) + " is not a whole number" +
                         (good ? " below " + std::to_string(limit) : ""));
        return std::nullopt;
    }
    return value;
}

std::uint32_t GltfReader::index(const Json& owner, const char* name, const std::string& element,
                                std::size_t limit, const char* of) {
    const auto value = whole(owner, name, element, kMostBytes);
    if (!value) {
        return kNoGltf;
    }
    if (*value >= limit) {
        bad(element, std::string(name) + " names " + of + " " + std::to_string(*value) +
                         ", but there are " + std::to_string(limit));
        return kNoGltf;
    }
    return static_cast<std::uint32_t>(*value);
}

double GltfReader::number(const Json& owner, const char* name, const std::string& element,
                          double otherwise) {
    const auto at = owner.find(name);
    if (at == owner.end()) {
        return otherwise;
    }
    if (!at->is_number() || !(std::fabs(at->get<double>()) < 1e30)) {
        bad(element, std::string(name) + " is not a number that can be used");
        return otherwise;
    }
    return at->get<double>();
}

bool GltfReader::numbers(const Json& owner, const char* name, const std::string& element,
                         double* out, std::size_t count) {
    const auto at = owner.find(name);
    if (at == owner.end()) {
        return false;
    }
    bool good = at->is_array() && at->size() == count;
    for (std::size_t i = 0; good && i < count; ++i) {
        good = (*at)[i].is_number() && std::fabs((*at)[i].get<double>()) < 1e30;
    }
    if (!good) {
        bad(element, std::string(name) + " is not a list of " + std::to_string(count) + " numbers");
        return false;
    }
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = (*at)[i].get<double>();
    }
    return true;
}

bool GltfReader::truth(const Json& owner, const char* name, const std::string& element) {
    const auto at = owner.find(name);
    if (at == owner.end()) {
        return false;
    }
    if (!at->is_boolean()) {
        bad(element, std::string(name) + " is neither true nor false");
        return false;
    }
    return at->get<bool>();
}

Checked<GltfDocument> GltfReader::read(std::string_view bytes) {
    PUP_TRY(const GltfContainer parts, split_gltf(bytes, path_));
    if (read_json(parts.json)) {
        read_asset();
        read_buffers(parts);
        read_views();
        read_accessors();
        read_images();
        read_textures();
        read_materials();
        read_meshes();
        read_skins();
        read_nodes();
        check_forest();
        read_roots();
        check_skinned_nodes();
        read_animations();
        read_humanoid();
        warn_of_lines();
    }
    if (defects_.any()) {
        return Unexpected(defects_.take());
    }
    return std::move(doc_);
}

bool GltfReader::read_json(std::string_view text) {
    if (!modest(text)) {
        error("too-large", "file", "its JSON is too large or too deeply nested",
              "make it smaller: at most " + std::to_string(kMostValues) + " values are read, " +
                  std::to_string(kMostDepth) + " deep");
        return false;
    }
    try {
        root_ = Json::parse(text);
    } catch (const Json::parse_error& e) {
        const std::string what = e.what();
        defects_.error("bad-json", place_of(path_, text, e.byte), "file",
                       "its JSON cannot be read: " + what.substr(what.find("] ") + 2),
                       "a glTF file begins with { (or with glTF, when it is a GLB); is it one?");
        return false;
    } catch (const Json::exception& e) {  // a number out of range
        error("bad-json", "file", std::string("its JSON cannot be read: ") + e.what(), kDamaged);
        return false;
    }
    if (!root_.is_object()) {
        error("bad-json", "file", "its JSON is not an object",
              "a glTF file begins with {; is it one?");
        return false;
    }
    return true;
}

void GltfReader::read_asset() {
    const Json* asset = object(root_, "asset", "file");
    const std::string version = asset != nullptr ? text(*asset, "version", "asset") : "";
    if (!version.starts_with("2.")) {
        error("gltf-version", "asset",
              version.empty() ? "the file does not say that it is glTF 2.0"
                              : "it is glTF " + version + ", not 2.0",
              "export it as glTF 2.0");
    }
    static constexpr std::string_view kKnown[] = {"KHR_mesh_quantization",
                                                  "KHR_texture_transform",
                                                  "KHR_materials_unlit",
                                                  "VRM",
                                                  "VRMC_vrm",
                                                  "VRMC_vrm_animation",
                                                  "VRMC_materials_mtoon",
                                                  "VRMC_springBone",
                                                  "VRMC_node_constraint",
                                                  "KHR_materials_specular",
                                                  "KHR_materials_ior",
                                                  "KHR_materials_clearcoat",
                                                  "KHR_materials_sheen",
                                                  "KHR_materials_emissive_strength",
                                                  "KHR_lights_punctual",
                                                  "KHR_materials_variants"};
    for (const Json& name : list(root_, "extensionsRequired", "file")) {
        const std::string wanted = name.is_string() ? name.get<std::string>() : "";
        if (std::find(std::begin(kKnown), std::end(kKnown), wanted) == std::end(kKnown)) {
            error("unsupported-extension", "extension " + wanted,
                  "the file cannot be read without it",
                  "export the file without compression and without this extension");
        }
    }
}

std::optional<std::string> GltfReader::bytes_of_uri(const std::string& uri,
                                                    const std::string& element,
                                                    std::string& media) {
    if (uri.starts_with("data:")) {
        auto bytes = decode_data_uri(uri, media);
        if (!bytes) {
            bad(element, "its data URI is not written in base64");
        }
        return bytes;
    }
    const auto relative = path_of_uri(uri);
    if (!relative || files_ == nullptr) {
        error("missing-file", element, "its data is at " + uri.substr(0, 200) + ", out of reach",
              "put it beside the file, or export as one GLB");
        return std::nullopt;
    }
    auto bytes = files_->read(files_->resolve(path_, *relative));
    if (!bytes) {
        error("missing-file", element, *relative + " cannot be used: " + bytes.error().message,
              "put it beside the file, or export as one GLB");
        return std::nullopt;
    }
    return std::move(*bytes);
}

void GltfReader::read_buffers(const GltfContainer& parts) {
    const Json& buffers = list(root_, "buffers", "file");
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::string element = gltf_element("buffer", i);
        const Json& buffer = buffers[i];
        std::string bytes;
        if (!buffer.is_object()) {
            bad(element, "it is not an object");
        } else if (buffer.contains("uri")) {
            std::string media;
            bytes = bytes_of_uri(text(buffer, "uri", element), element, media).value_or("");
        } else if (i == 0 && parts.has_binary) {
            bytes = std::string(parts.binary);
        } else {
            bad(element, "it has no data");
        }
        if (buffer.is_object()) {
            const auto length = whole(buffer, "byteLength", element, kMostBytes);
            if (length && *length > bytes.size() && !defects_.any()) {
                bad(element, "it shall have " + std::to_string(*length) + " bytes but has " +
                                 std::to_string(bytes.size()));
            }
        }
        total += bytes.size();
        if (total > GltfDocument::kLargestDecoded) {
            error("too-large", element, "the buffers have more than 256 MB together",
                  "export the figure alone");
            bytes.clear();
        }
        doc_.buffers_.push_back(std::move(bytes));
    }
}

void GltfReader::read_views() {
    const Json& views = list(root_, "bufferViews", "file");
    for (std::size_t i = 0; i < views.size(); ++i) {
        const std::string element = gltf_element("bufferView", i);
        GltfDocument::View made;
        if (!views[i].is_object()) {
            bad(element, "it is not an object");
        } else {
            const std::uint32_t buffer =
                index(views[i], "buffer", element, doc_.buffers_.size(), "buffer");
            made.offset = whole(views[i], "byteOffset", element, kMostBytes).value_or(0);
            made.length = whole(views[i], "byteLength", element, kMostBytes).value_or(0);
            made.stride =
                static_cast<std::uint32_t>(whole(views[i], "byteStride", element, 253).value_or(0));
            // One that is wrong is empty: nothing is read from it.
            if (buffer == kNoGltf) {
                bad(element, "it names no buffer");
                made = {};
            } else if (made.offset + made.length > doc_.buffers_[buffer].size()) {
                bad(element, "it reaches beyond the end of buffer " + std::to_string(buffer));
                made = {};
            } else {
                made.buffer = buffer;
            }
        }
        doc_.views_.push_back(made);
    }
}

bool GltfReader::view_holds(std::uint32_t view, std::uint64_t offset, std::uint64_t stride,
                            std::uint64_t size, std::uint64_t count, const std::string& element) {
    const GltfDocument::View& v = doc_.views_[view];
    if (count == 0 || (offset <= v.length && (count - 1) * stride + size <= v.length - offset)) {
        return true;
    }
    bad(element, "it reaches beyond the end of bufferView " + std::to_string(view));
    return false;
}

void GltfReader::read_accessors() {
    const Json& accessors = list(root_, "accessors", "file");
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const std::string element = gltf_element("accessor", i);
        const Json& accessor = accessors[i];
        GltfDocument::Accessor made;
        doc_.accessors_.push_back(made);
        if (!accessor.is_object()) {
            bad(element, "it is not an object");
            continue;
        }
        static constexpr std::pair<std::string_view, std::uint32_t> kTypes[] = {
            {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
            {"MAT2", 5},   {"MAT3", 9}, {"MAT4", 16}};
        const std::string type = text(accessor, "type", element);
        const auto known = std::find_if(std::begin(kTypes), std::end(kTypes),
                                        [&](const auto& t) { return t.first == type; });
        made.component_type = static_cast<std::uint32_t>(
            whole(accessor, "componentType", element, 65536).value_or(0));
        const std::uint32_t size = gltf_component_size(made.component_type);
        const auto count = whole(accessor, "count", element, kMostBytes);
        if (known == std::end(kTypes) || size == 0 || !count || *count == 0) {
            bad(element, known == std::end(kTypes) ? "its type is not one of glTF"
                         : size == 0               ? "its componentType is not one of glTF"
                                                   : "it has no count");
            continue;
        }
        made.components = known->second;
        made.normalized = truth(accessor, "normalized", element);
        made.offset = whole(accessor, "byteOffset", element, kMostBytes).value_or(0);
        made.view = index(accessor, "bufferView", element, doc_.views_.size(), "bufferView");
        made.count = static_cast<std::uint32_t>(*count);
        const std::uint64_t bytes = std::uint64_t{size} * made.components;
        // Small matrices are padded in ways that nobody here needs: they cannot be used.
        if (known->second == 5 || known->second == 9) {
            continue;
        }
        if (*count * bytes > GltfDocument::kLargestDecoded) {
            error("too-large", element, "it has " + std::to_string(*count) + " elements",
                  "export the figure alone");
            continue;
        }
        if (made.view != kNoGltf) {
            const std::uint32_t stride = doc_.views_[made.view].stride;
            if ((stride != 0 && stride < bytes) ||
                !view_holds(made.view, made.offset, stride != 0 ? stride : bytes, bytes, made.count,
                            element)) {
                if (stride != 0 && stride < bytes) {
                    bad(element, "its elements overlap");
                }
                continue;
            }
        }
        read_sparse(accessor, element, made);
        doc_.accessors_.back() = made;
    }
    finite_.assign(doc_.accessors_.size(), 0);
}

void GltfReader::read_sparse(const Json& accessor, const std::string& element,
                             GltfDocument::Accessor& made) {
    const Json* sparse = object(accessor, "sparse", element);
    if (sparse == nullptr) {
        return;
    }
    const auto count = whole(*sparse, "count", element, std::uint64_t{made.count} + 1);
    const Json* indices = object(*sparse, "indices", element);
    const Json* values = object(*sparse, "values", element);
    if (!count || *count == 0 || indices == nullptr || values == nullptr) {
        bad(element, "its sparse values are not complete");
        return;
    }
    const std::uint32_t type =
        static_cast<std::uint32_t>(whole(*indices, "componentType", element, 65536).value_or(0));
    const std::uint32_t index_view =
        index(*indices, "bufferView", element, doc_.views_.size(), "bufferView");
    const std::uint32_t value_view =
        index(*values, "bufferView", element, doc_.views_.size(), "bufferView");
    const bool unsigned_type = type == 5121 || type == 5123 || type == 5125;
    if (!unsigned_type || index_view == kNoGltf || value_view == kNoGltf) {
        bad(element, "its sparse values are not complete");
        return;
    }
    GltfDocument::Accessor at;  // the indices as an accessor of their own, to look through them
    at.view = index_view;
    at.offset = whole(*indices, "byteOffset", element, kMostBytes).value_or(0);
    at.count = static_cast<std::uint32_t>(*count);
    at.component_type = type;
    const std::uint64_t offset = whole(*values, "byteOffset", element, kMostBytes).value_or(0);
    const std::uint64_t size = gltf_component_size(type);
    const std::uint64_t bytes =
        std::uint64_t{gltf_component_size(made.component_type)} * made.components;
    if (doc_.views_[index_view].stride != 0 || doc_.views_[value_view].stride != 0) {
        bad(element, "its sparse values are in a view with a stride");
        return;
    }
    if (!view_holds(index_view, at.offset, size, size, at.count, element) ||
        !view_holds(value_view, offset, bytes, bytes, at.count, element)) {
        return;
    }
    doc_.accessors_.push_back(at);
    const auto list_of = doc_.integers(static_cast<std::uint32_t>(doc_.accessors_.size() - 1));
    doc_.accessors_.pop_back();
    for (const std::uint32_t i : list_of) {
        if (i >= made.count) {
            bad(element, "its sparse indices reach beyond its count");
            return;
        }
    }
    made.sparse_count = at.count;
    made.sparse_index_type = type;
    made.sparse_indices_view = index_view;
    made.sparse_indices_offset = at.offset;
    made.sparse_values_view = value_view;
    made.sparse_values_offset = offset;
}

bool GltfReader::use(std::uint32_t accessor, const std::string& element, const char* as,
                     std::initializer_list<std::uint32_t> components,
                     std::initializer_list<std::uint32_t> types, bool normalized_integers) {
    const GltfDocument::Accessor& a = doc_.accessors_[accessor];
    if (a.count == 0) {  // told already, but for small matrices
        if (!defects_.any()) {
            bad(element,
                std::string("accessor ") + std::to_string(accessor) + " has not the type of " + as);
        }
        return false;
    }
    const auto in = [](std::initializer_list<std::uint32_t> set, std::uint32_t value) {
        return std::find(set.begin(), set.end(), value) != set.end();
    };
    const bool whole_numbers = a.component_type != 5126;
    if (!in(components, a.components) || !in(types, a.component_type) ||
        (whole_numbers && normalized_integers && !a.normalized)) {
        bad(element,
            std::string("accessor ") + std::to_string(accessor) + " has not the type of " + as);
        return false;
    }
    decoded_ += std::uint64_t{a.count} * a.components * sizeof(float);
    if (decoded_ > GltfDocument::kLargestDecoded) {
        error("too-large", element, "what the file describes has more than 256 MB",
              "export the figure alone");
        return false;
    }
    if (!whole_numbers && finite_[accessor] == 0) {
        finite_[accessor] = 1;
        for (const float value : doc_.floats(accessor)) {
            if (!(std::fabs(value) < 1e30f)) {
                bad(gltf_element("accessor", accessor),
                    std::string("a number of ") + as + " is not finite");
                finite_[accessor] = 2;
                break;
            }
        }
    }
    return finite_[accessor] != 2;
}

void GltfReader::read_images() {
    const Json& images = list(root_, "images", "file");
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const std::string element = gltf_element("image", i);
        GltfImage made;
        if (!images[i].is_object()) {
            bad(element, "it is not an object");
        } else {
            made.name = text(images[i], "name", element);
            made.mime_type = text(images[i], "mimeType", element);
            if (images[i].contains("uri")) {
                made.bytes = bytes_of_uri(text(images[i], "uri", element), element, made.mime_type)
                                 .value_or("");
            } else {
                const std::uint32_t view =
                    index(images[i], "bufferView", element, doc_.views_.size(), "bufferView");
                if (view == kNoGltf) {
                    bad(element, "it has no data");
                } else {
                    const GltfDocument::View& v = doc_.views_[view];
                    made.bytes =
                        v.length > 0 ? doc_.buffers_[v.buffer].substr(v.offset, v.length) : "";
                }
            }
            // What it is, its first bytes know best.
            if (made.bytes.starts_with("\x89PNG")) {
                made.mime_type = "image/png";
            } else if (made.bytes.starts_with("\xFF\xD8\xFF")) {
                made.mime_type = "image/jpeg";
            } else if (!defects_.any()) {
                bad(element, "it is neither PNG nor JPEG");
            }
        }
        total += made.bytes.size();
        if (total > GltfDocument::kLargestDecoded) {
            error("too-large", element, "the images have more than 256 MB together",
                  "export the figure alone");
            made.bytes.clear();
        }
        doc_.images.push_back(std::move(made));
    }
}

}  // namespace puppetri::io

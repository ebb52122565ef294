// SPDX-License-Identifier: MIT
// Files that are cut off, damaged or made to harm: a diagnostic or a whole character, never a
// crash, never an hour.
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "io/survive_gltf.h"
#include "io/tiny_gltf.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::io::testing;

namespace {

std::vector<std::pair<std::string, std::string>> corpus() {
    TinyFile named;
    named.picture = true;
    TinyFile zero, one;
    zero.vrm = TinyFile::Vrm::kZero;
    one.vrm = TinyFile::Vrm::kOne;
    one.name = zero.name = [](const std::string& b) { return "n" + b; };
    std::vector<std::pair<std::string, std::string>> files{
        {"named.glb", tiny_glb(named)}, {"zero.vrm", tiny_glb(zero)}, {"one.vrm", tiny_glb(one)}};
    std::ifstream in(PUP_SOURCE_DIR "/../shared/motion/SimpleSkin.gltf", std::ios::binary);
    if (in) {
        files.emplace_back("SimpleSkin.gltf", std::string(std::istreambuf_iterator<char>(in), {}));
    } else {
        std::printf("skipped: ../shared/motion/SimpleSkin.gltf is missing\n");
    }
    return files;
}

std::string code_of(std::string bytes) {
    const auto document = GltfDocument::parse(std::move(bytes), "f.glb", nullptr);
    return document ? "" : document.error().front().code;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("the corpus itself is read [unit]") {
    for (const auto& [name, bytes] : corpus()) {
        CAPTURE(name);
        CHECK(GltfDocument::parse(bytes, name, nullptr).has_value());
        CHECK(broken_gltf_law(bytes) == "");
    }
}

TEST_CASE("every truncation of a figure's file is refused or read whole [hostile]") {
    for (const auto& [name, bytes] : corpus()) {
        CAPTURE(name);
        for (std::size_t length = 0; length < bytes.size(); ++length) {
            CAPTURE(length);
            const std::string cut = bytes.substr(0, length);
            REQUIRE(broken_gltf_law(cut) == "");
            REQUIRE(!GltfDocument::parse(cut, name, nullptr).has_value());
        }
    }
}

TEST_CASE("every damaged byte of a figure's file is refused or harmless [hostile]") {
    // A long form flips more bits of each byte.
    const bool all = std::getenv("PUPPETRI_LONG") != nullptr;
    const std::vector<unsigned char> flips =
        all ? std::vector<unsigned char>{0x01, 0x02, 0x0B, 0x10, 0x80, 0xFF}
            : std::vector<unsigned char>{0x01, 0x8A};
    for (const auto& [name, bytes] : corpus()) {
        CAPTURE(name);
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            CAPTURE(i);
            for (const unsigned char flip : flips) {
                std::string damaged = bytes;
                damaged[i] = static_cast<char>(static_cast<unsigned char>(damaged[i]) ^ flip);
                const std::string law = broken_gltf_law(damaged);
                REQUIRE_MESSAGE(law == "", law);
            }
        }
    }
}

TEST_CASE("files that are made to harm are refused by name [hostile]") {
    const TinyParts parts = tiny_parts({});
    const auto with = [&](const std::string& from, const std::string& to) {
        return code_of(glb_of(replaced(parts.json, from, to), parts.binary));
    };
    CHECK(with(R"("count":57,"type":"VEC3")", R"("count":4000000000,"type":"VEC3")") ==
          "too-large");
    CHECK(with(R"("count":57,"type":"VEC3")", R"("count":58,"type":"VEC3")") == "bad-gltf");
    CHECK(with(R"("count":57,"type":"VEC3")", R"("count":1e30,"type":"VEC3")") == "bad-gltf");
    CHECK(with(R"("componentType":5121)", R"("componentType":5125)") == "bad-gltf");
    CHECK(with(R"({"bufferView":0,)", R"({"bufferView":0,"byteOffset":18446744073709551615,)") ==
          "bad-gltf");
    CHECK(with(R"("children":[1,)", R"("children":[0,)") == "bad-gltf");  // its own child
    CHECK(with(R"("version":"2.0")", R"("version":"1.0")") == "gltf-version");
    CHECK(
        with(R"("scene":0)", R"("extensionsRequired":["KHR_draco_mesh_compression"],"scene":0)") ==
        "unsupported-extension");
    CHECK(with(R"("byteLength":)" + std::to_string(parts.binary.size()),
               R"("uri":"http://example.org/x.bin","byteLength":)" +
                   std::to_string(parts.binary.size())) == "missing-file");
    CHECK(code_of(std::string(100'000, '[')) == "too-large");
    CHECK(code_of("{" + std::string(10, ' ')) == "bad-json");
    CHECK(code_of("") == "not-gltf");
    CHECK(code_of("Kaydara FBX Binary") == "bad-json");
}

TEST_CASE(
    "bombs are refused quickly: small files that describe much, deep and long trees [hostile]") {
    // A million accessors over one view, all used; a chain of sixty thousand nodes; sixty thousand
    // nodes of one name.
    std::string many =
        R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1200000,"uri":"data:a;base64,)" +
        std::string(1600000, 'A') +
        R"("}],"bufferViews":[{"buffer":0,"byteLength":1200000}],"accessors":[{"bufferView":0,)"
        R"("componentType":5126,"count":100000,"type":"VEC3"}],"meshes":[)";
    for (int i = 0; i < 5000; ++i) {
        many += std::string(i > 0 ? "," : "") + R"({"primitives":[{"attributes":{"POSITION":0}}]})";
    }
    CHECK(code_of(many + "]}") == "too-large");
    std::string chain = R"({"asset":{"version":"2.0"},"nodes":[)", same = chain;
    constexpr int kNodes = 60'000;
    for (int i = 0; i < kNodes; ++i) {
        chain += std::string(i > 0 ? "," : "") + "{" +
                 (i + 1 < kNodes ? R"("children":[)" + std::to_string(i + 1) + "]" : "") + "}";
        same += std::string(i > 0 ? "," : "") + R"({"name":"a"})";
    }
    CHECK(broken_gltf_law(chain + "]}") == "");
    CHECK(broken_gltf_law(same + "]}") == "");
}

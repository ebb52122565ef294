// SPDX-License-Identifier: MIT
#include "gltf_container.h"

#include <array>
#include <cstdint>

namespace puppetri::io {
namespace {

constexpr std::size_t kHeader = 12, kChunkHeader = 8;
constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    }
    return word;
}

Unexpected<Diagnostics> defect(const char* code, const std::string& path, std::string message,
                               std::string remedy) {
    return Unexpected(Diagnostics{
        {Severity::kError, code, {path, 0, 0, 1}, "file", std::move(message), std::move(remedy)}});
}

Unexpected<Diagnostics> broken(const std::string& path, std::string message) {
    return defect("not-gltf", path, std::move(message),
                  "the file is cut off or damaged: fetch or export it again");
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') {
        return c - 'A';
    }
    if (c >= 'a' && c <= 'z') {
        return c - 'a' + 26;
    }
    if (c >= '0' && c <= '9') {
        return c - '0' + 52;
    }
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

std::optional<std::string> decode_base64(std::string_view text) {
    while (!text.empty() && text.back() == '=') {
        text.remove_suffix(1);
    }
    std::string bytes;
    bytes.reserve(text.size() * 3 / 4);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = base64_digit(c);
        if (digit < 0) {
            return std::nullopt;
        }
        bits = (bits << 6) | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes += static_cast<char>((bits >> count) & 0xFF);
        }
    }
    return bytes;
}

}  // namespace

Checked<GltfContainer> split_gltf(std::string_view bytes, const std::string& path) {
    if (bytes.empty()) {
        return broken(path, "the file is empty");
    }
    if (!bytes.starts_with("glTF")) {
        return GltfContainer{bytes, {}, false};
    }
    if (bytes.size() < kHeader + kChunkHeader) {
        return broken(path, "the file ends within the header of a GLB");
    }
    if (word_at(bytes, 4) != 2) {
        return defect("gltf-version", path,
                      "it is a GLB of version " + std::to_string(word_at(bytes, 4)) + ", not 2",
                      "export it as glTF 2.0");
    }
    const std::uint64_t total = word_at(bytes, 8);
    if (total > bytes.size() || total < kHeader + kChunkHeader) {
        return broken(path, "its header tells of " + std::to_string(total) + " bytes, but it has " +
                                std::to_string(bytes.size()));
    }
    bytes = bytes.substr(0, total);
    GltfContainer parts;
    bool first = true;
    for (std::size_t at = kHeader; at < bytes.size();) {
        if (bytes.size() - at < kChunkHeader ||
            word_at(bytes, at) > bytes.size() - at - kChunkHeader) {
            return broken(path, "a chunk reaches beyond the end of the file");
        }
        const std::size_t length = word_at(bytes, at);
        const std::uint32_t type = word_at(bytes, at + 4);
        const std::string_view content = bytes.substr(at + kChunkHeader, length);
        if (first != (type == kJson)) {
            return broken(path, first ? "its first chunk is not JSON" : "it has two JSON chunks");
        }
        if (first) {
            parts.json = content;
        } else if (type == kBinary && !parts.has_binary) {
            parts.binary = content;
            parts.has_binary = true;
        }
        first = false;
        at += kChunkHeader + length;
    }
    return parts;
}

std::optional<std::string> decode_data_uri(std::string_view uri, std::string& media) {
    constexpr std::string_view kStart = "data:", kCoding = ";base64";
    const std::size_t comma = uri.find(',');
    if (!uri.starts_with(kStart) || comma == std::string_view::npos) {
        return std::nullopt;
    }
    std::string_view head = uri.substr(kStart.size(), comma - kStart.size());
    if (!head.ends_with(kCoding)) {
        return std::nullopt;
    }
    head.remove_suffix(kCoding.size());
    media = std::string(head.substr(0, head.find(';')));
    return decode_base64(uri.substr(comma + 1));
}

std::optional<std::string> path_of_uri(std::string_view uri) {
    std::string path;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 &&
            hex_digit(uri[i + 2]) >= 0) {
            path += static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2]));
            i += 2;
        } else {
            path += uri[i];
        }
    }
    const std::size_t colon = uri.find(':');
    const bool scheme = colon != std::string_view::npos && colon < uri.find('/');
    if (path.empty() || scheme || path.front() == '/' || path.front() == '\\' ||
        path.find('\0') != std::string::npos) {
        return std::nullopt;
    }
    return path;
}

}  // namespace puppetri::io

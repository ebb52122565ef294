// SPDX-License-Identifier: MIT
// Names of many elements: one text, one array, one sorted order for looking up.
#include <algorithm>

#include "puppetri/net/tables.h"

namespace puppetri::net {

void Names::add(std::string_view path, std::string_view caption, const SourceSpan& where) {
    Entry e;
    e.path = static_cast<std::uint32_t>(text_.size());
    text_ += path;
    e.caption = static_cast<std::uint32_t>(text_.size());
    text_ += caption;
    e.end = static_cast<std::uint32_t>(text_.size());
    if (files_.empty() || files_.back() != where.file) {
        files_.push_back(where.file);
    }
    e.file = static_cast<std::uint32_t>(files_.size()) - 1;
    e.line = where.line;
    e.column = where.column;
    e.length = where.length;
    entries_.push_back(e);
}

void Names::sort(std::vector<std::pair<std::string, std::uint32_t>> aliases) {
    order_.resize(entries_.size());
    ranks_.resize(entries_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
        order_[i] = i;
    }
    std::sort(order_.begin(), order_.end(), [this](std::uint32_t a, std::uint32_t b) {
        const int c = path(a).compare(path(b));
        return c != 0 ? c < 0 : a < b;
    });
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
        ranks_[order_[i]] = i;
    }
    aliases_ = std::move(aliases);
    std::sort(aliases_.begin(), aliases_.end());
}

std::string_view Names::path(std::uint32_t i) const {
    const Entry& e = entries_[i];
    return std::string_view(text_).substr(e.path, e.caption - e.path);
}

ElementView Names::operator[](std::uint32_t i) const {
    const Entry& e = entries_[i];
    return {path(i),
            std::string_view(text_).substr(e.caption, e.end - e.caption),
            {files_[e.file], e.line, e.column, e.length}};
}

std::uint32_t Names::find(std::string_view wanted) const {
    const auto it =
        std::lower_bound(order_.begin(), order_.end(), wanted,
                         [this](std::uint32_t i, std::string_view w) { return path(i) < w; });
    if (it != order_.end() && path(*it) == wanted) {
        return *it;
    }
    const auto alias =
        std::lower_bound(aliases_.begin(), aliases_.end(), wanted,
                         [](const auto& a, std::string_view w) { return a.first < w; });
    return alias != aliases_.end() && alias->first == wanted ? alias->second : kNoIndex;
}

}  // namespace puppetri::net

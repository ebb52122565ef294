// SPDX-License-Identifier: MIT
#include "terminal.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <vector>

namespace puppetri::cli {
namespace {

double now_s() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

std::vector<std::string> lines_of(const std::string& path) {
    std::vector<std::string> lines;
    std::ifstream in(path, std::ios::binary);
    std::string line;
    while (in && std::getline(in, line)) {
        if (!line.empty() && line.back() == '\r') {
            line.pop_back();
        }
        lines.push_back(line);
    }
    return lines;
}

std::string time_left(double seconds) {
    char text[32];
    const long s = static_cast<long>(seconds + 0.5);
    if (s < 60) {
        std::snprintf(text, sizeof text, "%lds left", s);
    } else {
        std::snprintf(text, sizeof text, "%ldm%02lds left", s / 60, s % 60);
    }
    return text;
}

}  // namespace

bool on_terminal() { return isatty(STDERR_FILENO) != 0; }

bool colours() {
    const char* none = std::getenv("NO_COLOR");
    const char* term = std::getenv("TERM");
    return on_terminal() && (none == nullptr || *none == '\0') &&
           (term == nullptr || std::string_view(term) != "dumb");
}

void say(std::string_view line) {
    std::fprintf(stderr, "%.*s\n", static_cast<int>(line.size()), line.data());
}

void say_error(std::string_view message) {
    std::fprintf(stderr, "puppetri: %serror:%s %.*s\n", colours() ? "\033[1;31m" : "",
                 colours() ? "\033[0m" : "", static_cast<int>(message.size()), message.data());
}

void say_diagnostics(const Diagnostics& list) {
    std::map<std::string, std::vector<std::string>> files;
    for (const Diagnostic& d : list) {
        std::string line;
        if (!d.where.file.empty() && d.where.line > 0) {
            auto at = files.find(d.where.file);
            if (at == files.end()) {
                at = files.emplace(d.where.file, lines_of(d.where.file)).first;
            }
            if (d.where.line <= at->second.size()) {
                line = at->second[d.where.line - 1];
            }
        }
        std::fputs(format_diagnostic(d, line, colours()).c_str(), stderr);
    }
}

Progress::Progress(std::string what) : what_(std::move(what)), begin_s_(now_s()) {}

Progress::~Progress() {
    if (drawn_) {
        std::fputs("\r\033[K", stderr);
    }
}

void Progress::show(double done, std::string_view detail) {
    if (!on_terminal()) {
        return;
    }
    const double now = now_s();
    if (shown_s_ >= 0 && now - shown_s_ < 0.1) {
        return;
    }
    shown_s_ = now;
    drawn_ = true;
    done = done < 0 ? 0 : done > 1 ? 1 : done;
    constexpr int kWidth = 24;
    const int full = static_cast<int>(done * kWidth);
    std::string bar(static_cast<std::size_t>(full), '=');
    bar.resize(kWidth, ' ');
    const double spent = now - begin_s_;
    const std::string left =
        done > 0.02 && spent > 0.5 ? ", " + time_left(spent * (1 - done) / done) : "";
    std::fprintf(stderr, "\r\033[K%s [%s] %3d %%%s %.*s", what_.c_str(), bar.c_str(),
                 static_cast<int>(done * 100), left.c_str(), static_cast<int>(detail.size()),
                 detail.data());
    std::fflush(stderr);
}

std::string json_escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const unsigned char u = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (c == '\n') {
            out += "\\n";
        } else if (u < 0x20) {
            char hex[8];
            std::snprintf(hex, sizeof hex, "\\u%04x", u);
            out += hex;
        } else {
            out += c;
        }
    }
    return out;
}

std::string to_json(const Diagnostic& d) {
    const char* severity = d.severity == Severity::kError     ? "error"
                           : d.severity == Severity::kWarning ? "warning"
                                                              : "note";
    const auto text = [](const char* key, const std::string& value) {
        return std::string(", \"") + key + "\": \"" + json_escaped(value) + '"';
    };
    return std::string("{\"severity\": \"") + severity + '"' + text("code", d.code) +
           text("file", d.where.file) + ", \"line\": " + std::to_string(d.where.line) +
           ", \"column\": " + std::to_string(d.where.column) +
           ", \"length\": " + std::to_string(d.where.length) + text("element", d.element) +
           text("message", d.message) + text("remedy", d.remedy) + '}';
}

}  // namespace puppetri::cli

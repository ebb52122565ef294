// SPDX-License-Identifier: MIT
// Nets out: PNML, PIPE, TINA, LoLA, Graphviz, and scenes. What a format cannot say is refused by
// name, or dropped with a note; it is never written as something else.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/io/net_file.h"

namespace puppetri::io {

struct WriteNetOptions {
    bool lossy = false;  // drop what the format cannot say
};

struct WrittenNet {
    std::string text;
    Diagnostics notes;  // what was dropped or renamed: no errors
};

// By ending: .pnml, .xml (PIPE), .net (TINA), .lola, .dot and .gv (Graphviz), .pup.
std::optional<NetFormat> written_format_of(std::string_view path);
// By the name of the format, in any case: "pnml", "pipe", "tina", "lola", "dot", "graphviz", "pup".
std::optional<NetFormat> written_format_named(std::string_view name);

// Needs  a draft without holdings, fusions, rendezvous and refinements: net::lower() makes it so.
// Gives  a text that the format's reader turns into an equal draft (PNML, PIPE, TINA), where
//        nothing was dropped or renamed.
// Fails  "not-in-format", with the first elements of each kind that the format cannot say, unless
//        lossy.
Checked<WrittenNet> write_net(const NetFile& file, NetFormat to,
                              const WriteNetOptions& options = {});

}  // namespace puppetri::io

// SPDX-License-Identifier: MIT
// PNML 2009 (ISO/IEC 15909-2): place/transition nets with pages, reference nodes and the arc types
// that tools add; symmetric nets, which are unfolded. What is read, written and refused:
// docs/formats/pnml.md.
#pragma once
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/io/net_file.h"

namespace puppetri::io {

// `path` names the file in diagnostics.
// Gives  places and transitions in the order of the file. Whatever could change the behaviour and
//        is not understood (an arc type, a label, a net type) is an error, never skipped.
// Fails  with all defects of the file, each with line and element.
// Cost   linear in the text, for coloured nets in what they unfold to.
Checked<NetFile> read_pnml(std::string_view text, const std::string& path,
                           const NetLimits& limits = {});

}  // namespace puppetri::io

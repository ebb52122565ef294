// SPDX-License-Identifier: MIT
// One function per format: from a draft that the format can say (net_features.h) to its text.
#pragma once
#include <string>

#include "puppetri/base/diagnostic.h"
#include "puppetri/io/net_file.h"

namespace puppetri::io {

// `notes` gets what was renamed or rounded.
std::string pnml_text(const NetFile& file, Diagnostics& notes);
std::string pipe_text(const NetFile& file, Diagnostics& notes);
std::string tina_text(const NetFile& file, Diagnostics& notes);
std::string lola_text(const NetFile& file, Diagnostics& notes);
std::string graphviz_text(const NetFile& file, Diagnostics& notes);
std::string scene_text(const NetFile& file, Diagnostics& notes);

}  // namespace puppetri::io

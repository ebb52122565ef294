// SPDX-License-Identifier: MIT
// TINA's textual format .net: time Petri nets in the sense of Merlin, with priorities. What is
// read, written and refused: docs/formats/tina.md. Source  the manual page "formats" of the TINA
// toolbox; P. Merlin, D. Farber, "Recoverability of
//         communication protocols", IEEE Trans. Comm. 24 (1976).
#pragma once
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/time.h"
#include "puppetri/io/net_file.h"

namespace puppetri::io {

// An interval becomes a delay: [a,a] `after a`, [a,b] `after a .. b`, [0,0] none; of an open end
// the delay stays one tick away. [a,w[ becomes a normal delay that is cut to a or more: every value
// from a on is possible, none is certain. A file in which all intervals are [0,w[ has no time and
// gives a paced net. The unit of times is 1 s unless a comment `# unit 1 ms` says otherwise. Fails
// with all defects of the file.
Checked<NetFile> read_tina(std::string_view text, const std::string& path,
                           const NetLimits& limits = {});

// The delay that stands for [low,w[ of files with that unit, and back.
net::DurationDraft at_least(SimTime low, SimTime unit);
bool is_at_least(const net::DurationDraft& delay, SimTime& low);

}  // namespace puppetri::io

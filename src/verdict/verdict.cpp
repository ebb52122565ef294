// SPDX-License-Identifier: MIT
#include "puppetri/verdict/verdict.h"

namespace puppetri::verdict {

std::string name_of(const Verdict& verdict) {
    switch (verdict.answer) {
        case Answer::kProved:
            return verdict.force == Force::kEveryChoice      ? "PROVED for every choice"
                   : verdict.force == Force::kProbabilityOne ? "PROVED with probability 1"
                                                             : "PROVED";
        case Answer::kRefuted:
            return "REFUTED";
        case Answer::kSampled:
            return "SAMPLED";
        case Answer::kUnknown:
            break;
    }
    return "UNKNOWN";
}

int exit_status(const std::vector<Verdict>& verdicts, bool accept_sampled) {
    bool open = false;
    for (const Verdict& v : verdicts) {
        if (v.answer == Answer::kRefuted) {
            return 1;
        }
        open = open || v.answer == Answer::kUnknown ||
               (v.answer == Answer::kSampled && !accept_sampled);
    }
    return open ? 3 : 0;
}

}  // namespace puppetri::verdict

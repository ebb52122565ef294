// SPDX-License-Identifier: MIT
#include "scene_files.h"

#include "terminal.h"

namespace puppetri::cli {

Option file_option() {
    return {"--file", Value::kTexts, "NAME=PATH",
            "where the scene names the file NAME (a character, a clip, an import), take PATH",
            false};
}

bool use_files(const Arguments& arguments, io::DiskFiles& files) {
    for (const std::string& text : arguments.texts("--file")) {
        const std::size_t equal = text.find('=');
        if (equal == 0 || equal == std::string::npos || equal + 1 == text.size()) {
            say_error("--file: `" + text +
                      "` is not NAME=PATH; write --file CesiumMan.glb=models/CesiumMan.glb");
            return false;
        }
        files.replace(text.substr(0, equal), text.substr(equal + 1));
    }
    return true;
}

}  // namespace puppetri::cli

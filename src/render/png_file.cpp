// SPDX-License-Identifier: MIT
#ifdef PUPPETRI_WITH_PNG
#include <png.h>
#endif

#include <cstring>

#include "puppetri/base/require.h"
#include "puppetri/render/film.h"

namespace puppetri::render {

std::string encode_png(const Picture& picture) {
    PUP_REQUIRE(picture.rgb.size() == static_cast<std::size_t>(picture.width) *
                                          static_cast<std::size_t>(picture.height) * 3);
#ifdef PUPPETRI_WITH_PNG
    png_image image;
    std::memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(picture.width);
    image.height = static_cast<png_uint_32>(picture.height);
    image.format = PNG_FORMAT_RGB;
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
    png_alloc_size_t size = bytes.size();
    const int done =
        png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr);
    PUP_REQUIRE(done != 0);  // memory is all that it needs
    bytes.resize(size);
    return bytes;
#else
    PUP_REQUIRE(!"built without libpng: ask why_no_pictures() first");
    return {};
#endif
}

}  // namespace puppetri::render

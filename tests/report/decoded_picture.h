#pragma once

#include <png.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "report/picture.h"

namespace fcn::test {

/// A PNG read back by libpng's own reader.
struct DecodedPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;

    Color at(int x, int y) const {
        const std::size_t i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                   static_cast<std::size_t>(x));
        return {rgb[i], rgb[i + 1], rgb[i + 2]};
    }

    /// Pixels that are clearly more red than anything grey, blue or white.
    std::size_t red_pixels() const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < rgb.size(); i += 3)
            count += rgb[i] > rgb[i + 1] + 40 && rgb[i] > rgb[i + 2] + 40;
        return count;
    }
};

inline DecodedPicture decode_png(const std::string& bytes) {
    png_image image;
    std::memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()))
        throw std::runtime_error(std::string("not a PNG: ") + image.message);
    image.format = PNG_FORMAT_RGB;
    DecodedPicture picture;
    picture.width = static_cast<int>(image.width);
    picture.height = static_cast<int>(image.height);
    picture.rgb.resize(PNG_IMAGE_SIZE(image));
    if (!png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr))
        throw std::runtime_error(std::string("broken PNG: ") + image.message);
    return picture;
}

}  // namespace fcn::test

#include "report/png_writer.h"

#include <png.h>

#include "geometry/errors.h"

namespace fcn {
namespace {

void append_bytes(png_structp png, png_bytep bytes, png_size_t size) {
    static_cast<std::string*>(png_get_io_ptr(png))
        ->append(reinterpret_cast<const char*>(bytes), size);
}

void flush_nothing(png_structp) {}

[[noreturn]] void raise(png_structp, png_const_charp message) {
    throw LogicError(std::string("PNG encoder: ") + message);
}

void ignore_warning(png_structp, png_const_charp) {}

/// Frees libpng's structures on every way out; its errors are raised as exceptions.
struct Encoder {
    png_structp png = nullptr;
    png_infop info = nullptr;
    Encoder() {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, raise, ignore_warning);
        if (png) info = png_create_info_struct(png);
        if (!info) throw LogicError("PNG encoder: out of memory");
    }
    ~Encoder() { png_destroy_write_struct(&png, &info); }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
};

}  // namespace

std::string encode_png(const std::vector<std::uint8_t>& rgb, int width, int height) {
    const std::size_t stride = 3 * static_cast<std::size_t>(width);
    if (width <= 0 || height <= 0 || rgb.size() != stride * static_cast<std::size_t>(height))
        throw LogicError("PNG encoder: pixel count does not match the picture's size");
    std::string file;
    Encoder encoder;
    png_set_write_fn(encoder.png, &file, append_bytes, flush_nothing);
    png_set_IHDR(encoder.png, encoder.info, static_cast<png_uint_32>(width),
                 static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(encoder.png, 7);
    png_write_info(encoder.png, encoder.info);
    for (int y = 0; y < height; ++y)
        png_write_row(encoder.png, rgb.data() + stride * static_cast<std::size_t>(y));
    png_write_end(encoder.png, encoder.info);
    return file;
}

}  // namespace fcn

// Whole files in and out. Reading tells gzip by its first two bytes, whatever the name. Writing
// goes to a temporary file beside the target and is renamed when complete; the gzip header carries
// no time, so that equal content gives equal bytes.

#include "geometry/file_content.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>

#include "geometry/errors.h"
#include "geometry/mesh_io.h"

namespace fcn {

namespace fs = std::filesystem;

namespace {

std::string read_stream(std::istream& in) {
    std::string content;
    char block[1 << 16];
    while (in.read(block, sizeof block) || in.gcount() > 0) {
        content.append(block, static_cast<std::size_t>(in.gcount()));
    }
    return content;
}

void write_all(int descriptor, std::string_view content, const std::string& name) {
    while (!content.empty()) {
        const ssize_t written = ::write(descriptor, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) throw InputError(name + ": cannot write: " + std::strerror(errno));
        content.remove_prefix(static_cast<std::size_t>(written));
    }
}

/// Closes the descriptor and removes the file unless it was kept.
struct TemporaryFile {
    std::string path;
    int descriptor = -1;
    ~TemporaryFile() {
        if (descriptor >= 0) ::close(descriptor);
        if (!path.empty()) ::unlink(path.c_str());
    }
};

/// A symbolic link is followed, so that the rename replaces what it points to and not the link.
fs::path final_target(const fs::path& path) {
    std::error_code error;
    if (!fs::is_symlink(path, error)) return path;
    const fs::path resolved = fs::weakly_canonical(path, error);
    return error ? path : resolved;
}

}  // namespace

bool is_gzip(std::string_view content) {
    return content.size() >= 2 && content[0] == '\x1f' && content[1] == '\x8b';
}

std::string decompress(std::string_view content, const std::string& source) {
    z_stream stream{};
    if (inflateInit2(&stream, 15 + 16) != Z_OK) throw LogicError("zlib does not start");
    std::string result;
    int status = Z_OK;
    try {
        std::string block(1 << 18, '\0');
        while (!content.empty()) {
            const std::size_t piece = std::min<std::size_t>(content.size(), 1U << 30);
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
            stream.avail_in = static_cast<uInt>(piece);
            do {
                stream.next_out = reinterpret_cast<Bytef*>(block.data());
                stream.avail_out = static_cast<uInt>(block.size());
                status = inflate(&stream, Z_NO_FLUSH);
                result.append(block.data(), block.size() - stream.avail_out);
            } while (status == Z_OK && stream.avail_out == 0);
            content.remove_prefix(piece - stream.avail_in);
            if (status == Z_STREAM_END) {
                // Several members may follow one another; anything else behind is padding.
                if (!is_gzip(content)) break;
                inflateReset(&stream);
            } else if (status != Z_OK && !(status == Z_BUF_ERROR && stream.avail_in == 0)) {
                throw InputError(source + ": damaged gzip data after " +
                                 std::to_string(result.size()) + " bytes");
            }
        }
    } catch (...) {
        inflateEnd(&stream);
        throw;
    }
    inflateEnd(&stream);
    if (status != Z_STREAM_END) throw InputError(source + ": gzip data is truncated");
    return result;
}

std::string compress(std::string_view content) {
    z_stream stream{};
    if (deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
        throw LogicError("zlib does not start");
    }
    std::string result;
    std::string block(1 << 18, '\0');
    int status = Z_OK;
    while (status != Z_STREAM_END) {
        const std::size_t piece = std::min<std::size_t>(content.size(), 1U << 30);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
        stream.avail_in = static_cast<uInt>(piece);
        const int flush = piece == content.size() ? Z_FINISH : Z_NO_FLUSH;
        do {
            stream.next_out = reinterpret_cast<Bytef*>(block.data());
            stream.avail_out = static_cast<uInt>(block.size());
            status = deflate(&stream, flush);
            result.append(block.data(), block.size() - stream.avail_out);
        } while (stream.avail_out == 0);
        content.remove_prefix(piece);
    }
    deflateEnd(&stream);
    return result;
}

std::string read_content(std::istream& in, const std::string& source) {
    std::string content = read_stream(in);
    if (in.bad()) throw InputError(source + ": reading failed");
    return is_gzip(content) ? decompress(content, source) : content;
}

std::string read_file(const fs::path& path) {
    if (path == "-") return read_content(std::cin, "standard input");
    const std::string source = path.string();
    std::error_code error;
    if (fs::is_directory(path, error)) throw InputError(source + ": is a directory");
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) {
        throw InputError(source + ": cannot open: " + std::strerror(errno ? errno : ENOENT));
    }
    return read_content(in, source);
}

void write_file_atomically(const fs::path& path, std::string_view content) {
    static std::atomic<unsigned> serial{0};
    const std::string name = path.string();
    std::string compressed;
    if (path.extension() == ".gz") {
        compressed = compress(content);
        content = compressed;
    }
    if (path == "-") {
        std::cout.write(content.data(), static_cast<std::streamsize>(content.size())).flush();
        return;
    }
    const fs::path target = final_target(path);
    std::error_code error;
    const fs::file_status status = fs::status(target, error);
    if (fs::is_directory(status)) throw InputError(name + ": is a directory");
    TemporaryFile temporary;
    const bool is_special = fs::exists(status) && !fs::is_regular_file(status);
    if (is_special) {
        // A pipe or device cannot be replaced by a rename.
        temporary.descriptor = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
        std::string hidden(1, '.');
        hidden.append(target.filename().string()).append(1, '.');
        hidden.append(std::to_string(::getpid())).append(1, '.');
        hidden.append(std::to_string(serial++)).append(".part");
        temporary.path = (target.parent_path() / hidden).string();
        temporary.descriptor =
            ::open(temporary.path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    }
    if (temporary.descriptor < 0) {
        const int cause = errno;
        temporary.path.clear();
        throw InputError(name + ": cannot write: " + std::strerror(cause));
    }
    write_all(temporary.descriptor, content, name);
    const int descriptor = temporary.descriptor;
    temporary.descriptor = -1;
    if (::close(descriptor) != 0) {
        throw InputError(name + ": cannot write: " + std::strerror(errno));
    }
    if (is_special) return;
    if (::rename(temporary.path.c_str(), target.c_str()) != 0) {
        throw InputError(name + ": cannot write: " + std::strerror(errno));
    }
    temporary.path.clear();
}

}  // namespace fcn

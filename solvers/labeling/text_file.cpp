#include "labeling/text_file.h"

#include <unistd.h>
#include <zlib.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>

namespace labeling {
namespace {

constexpr unsigned kChunk = 1U << 18;

namespace fs = std::filesystem;

bool is_gzip_name(const fs::path& file) { return file.extension() == ".gz"; }

// Both write to `file` and name `shown` in their complaints.

void write_plain(const fs::path& file, std::string_view text, const std::string& shown) {
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) throw InputError(shown + ": cannot write: " + std::strerror(errno));
}

void write_gzip(const fs::path& file, std::string_view text, const std::string& shown) {
    const gzFile out = gzopen(file.c_str(), "wb9");
    if (out == nullptr) throw InputError(shown + ": cannot write: " + std::strerror(errno));
    bool is_good = true;
    while (!text.empty() && is_good) {
        const unsigned size = static_cast<unsigned>(std::min<std::size_t>(text.size(), kChunk));
        is_good = gzwrite(out, text.data(), size) == static_cast<int>(size);
        text.remove_prefix(size);
    }
    is_good = gzclose_w(out) == Z_OK && is_good;
    if (!is_good) throw InputError(shown + ": cannot write compressed data");
}

/// Hidden, in the same folder, and no other writer's.
fs::path temporary_beside(const fs::path& file) {
    static std::atomic<unsigned> serial{0};
    std::string name(1, '.');
    name.append(file.filename().string()).append(1, '.').append(std::to_string(::getpid()));
    name.append(1, '.').append(std::to_string(serial++)).append(".part");
    return file.parent_path() / name;
}

}  // namespace

std::string read_text_file(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        throw InputError(file.string() + ": is a directory");
    }
    const gzFile in = gzopen(file.c_str(), "rb");
    if (in == nullptr) {
        throw InputError(file.string() + ": cannot open: " + std::strerror(errno));
    }
    gzbuffer(in, kChunk);
    std::string text;
    std::unique_ptr<char[]> chunk(new char[kChunk]);
    int size = 0;
    while ((size = gzread(in, chunk.get(), kChunk)) > 0) text.append(chunk.get(), size);
    int status = Z_OK;
    gzerror(in, &status);
    const int closing = gzclose_r(in);
    if (size < 0 || status < 0 || closing == Z_BUF_ERROR) {
        throw InputError(file.string() + ": damaged or truncated gzip data");
    }
    return text;
}

void write_text_file(const fs::path& file, std::string_view text) {
    const std::string shown = file.string();
    const auto write = is_gzip_name(file) ? write_gzip : write_plain;
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (fs::is_directory(status)) throw InputError(shown + ": is a directory");
    // A pipe or device cannot be replaced by a rename, a link must not be.
    if (fs::exists(status) && !fs::is_regular_file(status)) return write(file, text, shown);
    const fs::path target = fs::is_symlink(file, error) ? fs::weakly_canonical(file) : file;
    const fs::path temporary = temporary_beside(target);
    try {
        write(temporary, text, shown);
    } catch (...) {
        fs::remove(temporary, error);
        throw;
    }
    fs::rename(temporary, target, error);
    if (error) {
        const std::string reason = error.message();
        fs::remove(temporary, error);
        throw InputError(shown + ": cannot write: " + reason);
    }
}

bool LineReader::next() {
    if (position_ >= text_.size()) return false;
    ++line_number_;
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    line_ = text_.substr(position_, end - position_);
    position_ = end + 1;
    words_.clear();
    constexpr std::string_view kBlanks = " \t\r\v\f";
    for (std::size_t from = 0;;) {
        from = line_.find_first_not_of(kBlanks, from);
        if (from == std::string_view::npos) break;
        const std::size_t to = std::min(line_.find_first_of(kBlanks, from), line_.size());
        words_.push_back(line_.substr(from, to - from));
        from = to;
    }
    return true;
}

void LineReader::fail(const std::string& message) const {
    throw InputError(source_ + ":" + std::to_string(line_number_) + ": " + message);
}

std::int64_t LineReader::integer(std::size_t index, std::string_view what) const {
    if (index >= words_.size()) fail("missing " + std::string(what));
    std::string_view word = words_[index];
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) {
        fail(std::string(what) + " '" + std::string(words_[index]) + "' is not an integer" +
             (error == std::errc::result_out_of_range ? " of 64 bits" : ""));
    }
    return number;
}

double LineReader::real(std::size_t index, std::string_view what) const {
    if (index >= words_.size()) fail("missing " + std::string(what));
    std::string_view word = words_[index];
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) {
        fail(std::string(what) + " '" + std::string(words_[index]) + "' is not a number");
    }
    return number;
}

std::string_view LineReader::rest(std::size_t index) const {
    if (index >= words_.size()) return {};
    const char* from = words_[index].data();
    const char* to = words_.back().data() + words_.back().size();
    return {from, static_cast<std::size_t>(to - from)};
}

}  // namespace labeling

#include "experiment/best_solution.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <charconv>

#include "labeling/text_file.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;

/// Waits for its turn: runs next to each other may both have found something.
class Turn {
public:
    explicit Turn(const fs::path& file)
        : file_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
        if (file_ >= 0) ::flock(file_, LOCK_EX);
    }
    ~Turn() {
        if (file_ >= 0) ::close(file_);
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

private:
    int file_;
};

}  // namespace

fs::path best_solution_file(const fs::path& folder, const std::string& hash) {
    return folder / "best" / (hash + ".sol.gz");
}

std::optional<std::int64_t> best_solution_value(const fs::path& folder, const std::string& hash) {
    const fs::path file = best_solution_file(folder, hash);
    if (!fs::exists(file)) return std::nullopt;
    const std::string text = labeling::read_text_file(file);
    labeling::LineReader lines(text, file.string());
    while (lines.next()) {
        if (!lines.words().empty() && lines.words()[0] == "v") return lines.integer(1, "value");
    }
    return std::nullopt;
}

void keep_if_best(const fs::path& folder, const std::string& hash, const fs::path& solution,
                  std::int64_t value) {
    fs::create_directories(folder / "best");
    const Turn turn(folder / "best" / "lock");
    const auto kept = best_solution_value(folder, hash);
    if (kept && *kept >= value) return;
    labeling::write_text_file(best_solution_file(folder, hash), labeling::read_text_file(solution));
}

}  // namespace experiment

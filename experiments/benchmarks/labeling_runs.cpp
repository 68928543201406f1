#include "labeling_runs.h"

#include <sys/resource.h>

#include <algorithm>
#include <string>

#include "labeling/errors.h"
#include "labeling/renaming.h"

#ifdef LABELING_WITH_MIP
#include "labeling_mip/mip_solvers.h"
#endif

namespace labeling_runs {

namespace fs = std::filesystem;
using labeling::LabelingProblem;

labeling::SolverRegistry every_solver() {
#ifdef LABELING_WITH_MIP
    return labeling::all_solvers();
#else
    return labeling::builtin_solvers();
#endif
}

Variant parse_variant(const std::string& text) {
    const std::size_t end = std::min(text.find(':'), text.size());
    Variant variant{text, text.substr(0, end), {}};
    for (std::size_t from = end; from < text.size();) {
        const std::size_t to = std::min(text.find(':', from + 1), text.size());
        const std::string pair = text.substr(from + 1, to - from - 1);
        const std::size_t at = pair.find('=');
        if (at == std::string::npos) {
            throw labeling::InputError("'" + pair + "' is not KEY=VALUE");
        }
        variant.extra[pair.substr(0, at)] = pair.substr(at + 1);
        from = to;
    }
    return variant;
}

std::vector<fs::path> problem_files(const fs::path& path) {
    if (!fs::is_directory(path)) return {path};
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".lab") || name.ends_with(".lab.gz")) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::string problem_name(const fs::path& file) {
    const std::string name = file.filename().string();
    return name.substr(0, name.find(".lab"));
}

LabelingProblem renamed(const LabelingProblem& problem, std::uint64_t seed) {
    return labeling::rename_labels(problem, seed).problem;
}

double processor_seconds() {
    double seconds = 0;
    for (int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        getrusage(who, &usage);
        seconds += static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                   1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
    }
    return seconds;
}

}  // namespace labeling_runs

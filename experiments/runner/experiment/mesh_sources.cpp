#include "experiment/mesh_sources.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "experiment/pattern.h"
#include "experiment/programs.h"
#include "labeling/errors.h"
#include "labeling/text_file.h"
#include "labeling_mip/external_process.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;

/// Marks what is complete, and holds the hash of the program that made it.
constexpr const char* kDone = "done";

bool is_done(const fs::path& home, const std::string& program) {
    std::ifstream in(home / kDone, std::ios::binary);
    return in && std::string(std::istreambuf_iterator<char>(in), {}) == program;
}

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

/// Letters and digits of a text, for names of files: "2%" is "2pct", "vsa 200" is "vsa200".
std::string plain_name(const std::string& text) {
    std::string name;
    for (const char c : text) {
        if (c == '%') {
            name += "pct";
        } else if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-') {
            name += c;
        }
    }
    return name;
}

/// What was made of one mesh must not be taken for what another one gives: neither where two have
/// one name, nor where a mesh has changed since a preparation that was killed.
void copy_mesh(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::create_directories(to.parent_path());
    if (fs::exists(to)) {
        if (labeling::read_text_file(from) == labeling::read_text_file(to)) return;
        throw labeling::InputError(from.string() + ": another mesh is " + to.string() +
                                   " already; give it another name, or prepare in a new folder");
    }
    fs::copy_file(from, to, fs::copy_options::none, error);
    if (error) {
        throw labeling::InputError(from.string() + ": cannot be copied: " + error.message());
    }
}

MeshSource model_source(const std::string& text, const fs::path& folder) {
    std::vector<std::string> words = words_of(text);
    if (words.empty()) throw labeling::InputError("meshes: 'model:' needs a name");
    const std::string name = plain_name(text);
    const fs::path file = folder / "meshes" / (name + ".off");
    fs::create_directories(file.parent_path());
    words.insert(words.begin(), {own_program("scalefcn").string(), "model"});
    words.insert(words.end(), {"-o", file.string(), "--quiet"});
    run_own_program(words, folder / "meshes" / (name + ".log"));
    return {name, file};
}

fs::path cgal_mesh(const std::string& name) {
    const char* chosen = std::getenv("SCALEFCN_MESHES");
    const fs::path folder =
        chosen != nullptr ? fs::path(chosen) : source_folder() / "build" / "meshes";
    for (const char* extension : {"", ".off", ".obj", ".ply", ".stl"}) {
        const fs::path file = folder / (name + extension);
        if (fs::is_regular_file(file)) return file;
    }
    throw labeling::InputError("mesh cgal:" + name + " is not in " + folder.string() +
                               "; scripts/fetch_meshes.sh " + name +
                               " fetches it from Debian's libcgal-demo");
}

}  // namespace

std::vector<MeshSource> mesh_sources(const std::vector<std::string>& patterns,
                                     const fs::path& config_folder, const fs::path& folder) {
    std::vector<MeshSource> meshes;
    const auto take = [&](const fs::path& file) {
        const fs::path copy = folder / "meshes" / file.filename();
        copy_mesh(file, copy);
        meshes.push_back({file.stem().string(), copy});
    };
    for (const std::string& pattern : patterns) {
        if (pattern.starts_with("model:")) {
            meshes.push_back(model_source(pattern.substr(6), folder));
        } else if (pattern.starts_with("cgal:")) {
            take(cgal_mesh(pattern.substr(5)));
        } else {
            const auto files = matching_files(pattern, config_folder);
            if (files.empty()) throw labeling::InputError("meshes: nothing matches " + pattern);
            for (const fs::path& file : files) take(file);
        }
    }
    return meshes;
}

std::string adaptation_name(const std::string& mesh, const AdaptRequest& request) {
    std::string name = mesh + "_" + plain_name(request.detector) + "_" + plain_name(request.scale) +
                       "_" + request.mode + "_" + request.target;
    for (const std::string& option : request.options) name += "_" + plain_name(option);
    return name;
}

std::vector<std::string> detector_words(const std::string& detector) {
    const auto words = words_of(detector);
    if (words.empty() || words.size() > 2) {
        throw labeling::InputError("detectors: '" + detector +
                                   "' is not a method, or vsa and a number of patches");
    }
    std::vector<std::string> result{"--method", words[0]};
    if (words.size() == 2) result.insert(result.end(), {"--patches", words[1]});
    return result;
}

void run_own_program(const std::vector<std::string>& words, const fs::path& log) {
    labeling::ProgramRun run;
    run.words = words;
    run.folder = fs::current_path();
    run.output_file = fs::absolute(log);
    run.error_file = fs::absolute(log).string() + ".errors";
    const auto outcome = labeling::run_program(run);
    if (outcome.end == labeling::ProgramEnd::NotFound) {
        throw labeling::InputError("the program " + words[0] + " is missing; build it first");
    }
    if (outcome.end == labeling::ProgramEnd::Exited && outcome.exit_code == 0) return;
    std::ifstream errors(run.error_file);
    std::string line, last;
    while (std::getline(errors, line)) {
        if (!line.empty()) last = line;
    }
    throw labeling::InputError(fs::path(words[0]).filename().string() + " " + words[1] +
                               " failed: " + last + " (" + run.error_file.string() + ")");
}

std::vector<fs::path> adapted_problems(const MeshSource& mesh, const AdaptRequest& request,
                                       const fs::path& folder) {
    const std::string part = request.wants_first_only ? "_first" : "";
    const fs::path home = folder / "adapted" / (adaptation_name(mesh.name, request) + part);
    const fs::path saved = home / "problems";
    const std::string program = program_hash("scalefcn");
    if (!is_done(home, program)) {
        fs::remove_all(home);
        fs::create_directories(home);
        std::vector<std::string> words{own_program("scalefcn").string(), "adapt",
                                       mesh.file.string(), "--scale", request.scale};
        for (const std::string& word : detector_words(request.detector)) words.push_back(word);
        words.insert(words.end(), {"--mode", request.mode, "--target", request.target});
        words.insert(words.end(), request.options.begin(), request.options.end());
        if (request.wants_first_only) {
            words.insert(words.end(), {"--solver", "greedy", "--max-iterations", "1"});
        }
        words.insert(words.end(), {"--save-problems", saved.string(), "-q", "--no-timings", "-o",
                                   (home / "network.fcn.json").string()});
        run_own_program(words, home / "log");
        labeling::write_text_file(home / kDone, program);
    }
    std::vector<fs::path> files;
    for (int k = 1;; ++k) {
        const fs::path file = saved / ("problem_" + std::to_string(k) + ".lab.gz");
        if (!fs::exists(file)) break;
        files.push_back(file);
    }
    return files;
}

}  // namespace experiment

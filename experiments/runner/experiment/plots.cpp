#include "experiment/plots.h"

#include <fstream>

#include "experiment/programs.h"
#include "labeling/text_file.h"
#include "labeling_mip/external_process.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSetup = "scripts/setup_experiments.sh matplotlib numpy";

std::string last_line(const fs::path& file) {
    std::ifstream in(file);
    std::string line, last;
    while (std::getline(in, line)) {
        if (!line.empty()) last = line;
    }
    return last;
}

std::string note_of(const labeling::ProgramOutcome& outcome, const std::string& python,
                    const std::string& said) {
    if (outcome.end == labeling::ProgramEnd::NotFound) {
        return "no plots: no Python at '" + python + "'. This sets it up: " + kSetup;
    }
    if (said.find("ModuleNotFoundError") != std::string::npos ||
        said.find("ImportError") != std::string::npos) {
        return "no plots: the Python '" + python +
               "' has no matplotlib. This sets it up: " + kSetup;
    }
    return "no plots: drawing them failed: " + (said.empty() ? outcome.message : said);
}

}  // namespace

DrawnPlots draw_plots(const nlohmann::json& figures, const fs::path& folder) {
    DrawnPlots drawn;
    const nlohmann::json data{{"figures", figures}};
    labeling::write_text_file(folder / "plots.json", data.dump(1) + "\n");
    const fs::path plots = folder / "plots";
    fs::remove_all(plots);
    if (figures.empty()) return drawn;
    fs::create_directories(plots);

    const labeling::ScratchFolder scratch;
    labeling::write_text_file(scratch.path() / "plots.py", plots_text());
    labeling::ProgramRun run;
    const std::string python = python_for_plots();
    run.words = {python, (scratch.path() / "plots.py").string(),
                 fs::absolute(folder / "plots.json").string(), fs::absolute(plots).string()};
    run.folder = scratch.path();
    run.output_file = scratch.path() / "output";
    run.error_file = scratch.path() / "errors";
    const auto outcome = labeling::run_program(run);
    if (outcome.end != labeling::ProgramEnd::Exited || outcome.exit_code != 0) {
        drawn.note = note_of(outcome, python, last_line(run.error_file));
        fs::remove_all(plots);
        return drawn;
    }
    for (const auto& figure : figures) {
        const std::string name = figure.at("name");
        drawn.svg[name] = labeling::read_text_file(plots / (name + ".svg"));
    }
    return drawn;
}

}  // namespace experiment

#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace experiment {

struct DrawnPlots {
    std::map<std::string, std::string> svg;  ///< texts by the figures' names
    std::string note;                        ///< why there are none; or empty
};

/// Text of plots.py, compiled in: it is found wherever the program is.
const char* plots_text();

/// Writes plots.json and, with the Python that has matplotlib, plots/NAME.svg and NAME.pdf into
/// `folder`. Without matplotlib there are no plots and a note says how to get it. Throws InputError
/// when the folder cannot be written.
DrawnPlots draw_plots(const nlohmann::json& figures, const std::filesystem::path& folder);

}  // namespace experiment

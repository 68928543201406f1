#pragma once

#include <set>
#include <string>

#include "experiment/report_document.h"

namespace experiment {

/// GitHub's Markdown. Figures that are in `plots` are shown from plots/NAME.svg, others left out.
std::string to_markdown(const Document& document, const std::set<std::string>& plots);

}  // namespace experiment

#pragma once

#include <map>
#include <string>

#include "experiment/report_document.h"

namespace experiment {

/// One self-contained page: style, script and pictures inside. `plots`: SVG texts by name. Tables
/// sort by a click on a column's head; without scripts they are in the order given.
std::string to_html(const Document& document, const std::map<std::string, std::string>& plots);

/// RFC 4648.
std::string base64(const std::string& bytes);

}  // namespace experiment

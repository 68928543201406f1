#pragma once

#include <string>

#include "meshing/remesh_quads.h"
#include "report/html.h"

namespace fcn {

/// How quads were made and, if not as asked for, why: a sentence or two for a person.
std::string tier_words(const QuadResult& result);

/// The attempts at a field, one a row: edge length, sizes, and where and why it ended.
HtmlTable attempt_table(const std::vector<QuadAttempt>& attempts);

}  // namespace fcn

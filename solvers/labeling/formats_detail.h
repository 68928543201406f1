#pragma once

#include <string>
#include <string_view>

#include "labeling/linear_model.h"
#include "labeling/problem.h"

/// One reader and one writer per format; formats.cpp picks by name.
namespace labeling::detail {

LabelingProblem parse_lab(std::string_view text, std::string_view source);
std::string format_lab(const LabelingProblem& problem);

LabelingProblem parse_mps(std::string_view text, std::string_view source);
std::string format_mps(const LinearModel& model);

LabelingProblem parse_lp(std::string_view text, std::string_view source);
std::string format_lp(const LinearModel& model);

LabelingProblem parse_opb(std::string_view text, std::string_view source);
std::string format_opb(const LinearModel& model);

LabelingProblem parse_cfn(std::string_view text, std::string_view source);
std::string format_cfn(const LabelingProblem& problem);

LabelingProblem parse_metis(std::string_view text, std::string_view source);
std::string format_metis(const LabelingProblem& problem);

/// Appends the decimal digits of a number.
void append(std::string& out, std::int64_t number);

}  // namespace labeling::detail

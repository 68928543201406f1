#include "report/quad_words.h"

#include <map>

namespace fcn {
namespace {

/// What it means that a step failed.
std::string failure_words(const std::string& step) {
    static const std::map<std::string, std::string> kWords{
        {"domain", "no triangles that could carry a field"},
        {"field", "no cross field"},
        {"map", "no map to the plane without folds"},
        {"extraction", "no quads could be read from the map"},
        {"smoothing", "quads that stayed turned over"}};
    const auto found = kWords.find(step);
    return found == kWords.end() ? step : found->second;
}

std::string failures_words(const std::vector<QuadAttempt>& attempts) {
    std::string text;
    for (const QuadAttempt& attempt : attempts) {
        if (attempt.reason.empty()) continue;
        text += (text.empty() ? "" : "; ") +
                ("edge length " + format_significant(attempt.edge_length)) + " gave " +
                failure_words(attempt.step);
    }
    return text;
}

}  // namespace

std::string tier_words(const QuadResult& result) {
    const std::string length = format_significant(result.edge_length);
    if (result.tier == QuadTier::Field) {
        std::string text = "Along a cross field, edge length " + length;
        const std::string failures = failures_words(result.attempts);
        return failures.empty() ? text + "." : text + ", shorter than asked for: " + failures + ".";
    }
    std::string text = "By pairing triangles, edge length " + length;
    if (result.attempts.empty()) return text + ", as asked for.";
    return text +
           ", since no attempt along a cross field succeeded: " + failures_words(result.attempts) +
           ".";
}

HtmlTable attempt_table(const std::vector<QuadAttempt>& attempts) {
    HtmlTable table;
    table.caption = "Attempts at quads along a cross field";
    table.header = {"Edge length", "Ended at", "Why", "Triangles under the field", "Singularities"};
    table.text_columns = 3;
    for (const QuadAttempt& attempt : attempts)
        table.rows.push_back({format_significant(attempt.edge_length),
                              attempt.reason.empty() ? "quads" : attempt.step,
                              attempt.reason.empty() ? "succeeded" : attempt.reason,
                              std::to_string(attempt.triangles),
                              std::to_string(attempt.singularities)});
    return table;
}

}  // namespace fcn

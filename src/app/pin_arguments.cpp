#include "app/pin_arguments.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "adaptation/pin_check.h"
#include "app/command.h"
#include "app/importance_file.h"
#include "app/length.h"
#include "geometry/errors.h"

namespace fcn::app {
namespace {

/// Stretches that boxes and paint pin are at least this long, in rmin.
constexpr double kShortestStretch = 2;

PinRule parse_number(const std::string& text, Pin pin, const std::string& option) {
    PinRule rule;
    rule.pin = pin;
    rule.name = option + " " + text;
    const std::size_t colon = text.find(':');
    const std::string what = text.substr(0, colon);
    rule.target = what == "curve" ? PinRule::Target::Curve : PinRule::Target::Arc;
    const char* begin = text.data() + (colon == std::string::npos ? text.size() : colon + 1);
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(begin, end, rule.index);
    if ((what != "arc" && what != "curve") || error != std::errc{} || stop != end || rule.index < 0)
        throw UsageError(
            fmt::format("{}: '{}' is neither arc:NUMBER nor curve:NUMBER", option, text));
    return rule;
}

PinRule parse_box(const std::string& text, Pin pin, const std::string& option) {
    const std::vector<std::string> entries = split_list(text, option);
    std::vector<double> numbers;
    for (const std::string& entry : entries) {
        double value = 0;
        const char* end = entry.data() + entry.size();
        const auto [stop, error] = std::from_chars(entry.data(), end, value);
        if (error == std::errc{} && stop == end && std::isfinite(value)) numbers.push_back(value);
    }
    if (entries.size() != 6 || numbers.size() != 6)
        throw UsageError(
            fmt::format("{}: '{}' is no box x0,y0,z0,x1,y1,z1 in mesh units", option, text));
    PinRule rule;
    rule.target = PinRule::Target::Box;
    rule.pin = pin;
    rule.name = option + " " + text;
    rule.box.extend(Vec3(numbers[0], numbers[1], numbers[2]));
    rule.box.extend(Vec3(numbers[3], numbers[4], numbers[5]));
    return rule;
}

}  // namespace

std::vector<PinRule> PinArguments::rules() const {
    std::vector<PinRule> rules;
    const auto add_numbers = [&](const std::vector<std::string>& texts, Pin pin,
                                 const std::string& option) {
        for (const std::string& text : texts)
            for (const std::string& entry : split_list(text, option))
                rules.push_back(parse_number(entry, pin, option));
    };
    add_numbers(keep, Pin::Keep, "--keep");
    add_numbers(drop, Pin::Drop, "--drop");
    for (const std::string& text : keep_boxes)
        rules.push_back(parse_box(text, Pin::Keep, "--keep-box"));
    for (const std::string& text : drop_boxes)
        rules.push_back(parse_box(text, Pin::Drop, "--drop-box"));
    return rules;
}

void add_pin_arguments(CLI::App& parser, PinArguments& arguments) {
    constexpr const char* kGroup = "Pins: what must be kept or dropped";
    const auto add_list = [&](const char* name, std::vector<std::string>& list, const char* text) {
        parser.add_option(name, list, text)->group(kGroup)->allow_extra_args(false);
    };
    add_list("--keep", arguments.keep,
             "Arcs or curves of the initial network, by number: arc:12,curve:3");
    add_list("--drop", arguments.drop, "The same, to be left out");
    add_list("--keep-box", arguments.keep_boxes,
             "Features inside a box x0,y0,z0,x1,y1,z1 (mesh units); may be repeated");
    add_list("--drop-box", arguments.drop_boxes, "The same, to be left out");
    parser
        .add_option("--importance", arguments.importance_path,
                    "Painted values: PLY with a vertex property, or text (a number a vertex)")
        ->group(kGroup);
    parser
        .add_option("--importance-property", arguments.importance_property,
                    "Name of the PLY property")
        ->group(kGroup)
        ->capture_default_str();
    parser
        .add_option("--keep-above", arguments.keep_above,
                    "Features are kept where the importance is at least this")
        ->group(kGroup)
        ->capture_default_str();
    parser
        .add_option("--drop-below", arguments.drop_below,
                    "Features are left out where the importance is at most this")
        ->group(kGroup)
        ->capture_default_str();
    parser
        .add_option("--pin-conflicts", arguments.conflicts,
                    "Pins that the scale cannot hold: refuse, or keep them in violation of it")
        ->group(kGroup)
        ->check(CLI::IsMember({"refuse", "keep"}))
        ->capture_default_str();
}

void add_pins(Detection& detection, const LoadedMesh& mesh, const PinArguments& arguments,
              double rmin) {
    const std::vector<PinRule> rules = arguments.rules();
    if (rules.empty() && arguments.importance_path.empty()) return;
    PaintedImportance importance;
    importance.keep_above = arguments.keep_above;
    importance.drop_below = arguments.drop_below;
    importance.name = arguments.importance_path;
    if (!(importance.keep_above > importance.drop_below))
        throw UsageError(fmt::format("--keep-above {} must exceed --drop-below {}",
                                     importance.keep_above, importance.drop_below));
    if (!arguments.importance_path.empty())
        importance.of_vertex =
            read_importance(arguments.importance_path, arguments.importance_property, mesh);
    const std::size_t note_count = detection.network.notes.size();
    detection.network =
        apply_pins(detection.network, mesh, rules, importance, {kShortestStretch * rmin});
    const auto& notes = detection.network.notes;
    detection.messages.insert(detection.messages.end(), notes.begin() + note_count, notes.end());
}

std::vector<std::string> require_pins_hold(const FeatureCurveNetwork& network,
                                           const LoadedMesh& mesh, const AdaptationOptions& options,
                                           const PinArguments& arguments) {
    const PinCheck check = check_pins(mesh, network, options);
    if (check.conflicts.empty()) return {};
    std::string text = fmt::format("{}: pins cannot hold at scale {:.4g}: {}", mesh.name,
                                   options.rmin, check.conflicts.front().message(options.rmin));
    if (check.conflict_count > 1)
        text += fmt::format(" (and {} more pairs)", check.conflict_count - 1);
    if (arguments.conflicts == "keep") return {text};
    throw InputError(text);
}

}  // namespace fcn::app

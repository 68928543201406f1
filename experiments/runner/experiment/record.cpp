#include "experiment/record.h"

#include <array>

#include "experiment/json_values.h"
#include "labeling/errors.h"

namespace experiment {
namespace {

using nlohmann::json;

struct OutcomeName {
    Outcome outcome;
    const char* name;
};

constexpr std::array<OutcomeName, 11> kOutcomes{{
    {Outcome::Optimal, "optimal"},
    {Outcome::Feasible, "feasible"},
    {Outcome::Infeasible, "infeasible"},
    {Outcome::NoSolution, "no-solution"},
    {Outcome::NotApplicable, "not-applicable"},
    {Outcome::Missing, "missing"},
    {Outcome::Timeout, "timeout"},
    {Outcome::OutOfMemory, "out-of-memory"},
    {Outcome::DiskFull, "disk-full"},
    {Outcome::Crash, "crash"},
    {Outcome::Wrong, "wrong"},
}};

std::optional<std::int64_t> integer_or_nothing(const json& value) {
    if (value.is_null()) return std::nullopt;
    return value.get<std::int64_t>();
}

json to_json(const Measures& m) {
    return {{"wall_seconds", m.wall_seconds},
            {"user_seconds", m.user_seconds},
            {"system_seconds", m.system_seconds},
            {"peak_mib", m.peak_mib},
            {"instructions", or_null(m.instructions)},
            {"load", m.load},
            {"processor", m.processor},
            {"exit_code", m.exit_code},
            {"signal", m.signal},
            {"started_at", m.started_at}};
}

Measures measures_from(const json& j) {
    Measures m;
    m.wall_seconds = j.at("wall_seconds");
    m.user_seconds = j.at("user_seconds");
    m.system_seconds = j.at("system_seconds");
    m.peak_mib = j.at("peak_mib");
    m.instructions = integer_or_nothing(j.at("instructions"));
    m.load = j.at("load");
    m.processor = j.at("processor");
    m.exit_code = j.at("exit_code");
    m.signal = j.at("signal");
    m.started_at = j.at("started_at");
    return m;
}

}  // namespace

std::string to_string(Outcome outcome) {
    for (const OutcomeName& entry : kOutcomes) {
        if (entry.outcome == outcome) return entry.name;
    }
    throw labeling::LogicError("outcome without a name");
}

Outcome outcome_from(const std::string& text) {
    for (const OutcomeName& entry : kOutcomes) {
        if (text == entry.name) return entry.outcome;
    }
    throw labeling::InputError("'" + text + "' is no outcome of a run");
}

bool is_solved(Outcome outcome) {
    return outcome == Outcome::Optimal || outcome == Outcome::Feasible;
}

json to_json(const Record& r) {
    json trace = json::array();
    for (const TracePoint& p : r.trace) {
        trace.push_back({p.seconds, p.work, or_null(p.value), or_null(p.bound)});
    }
    return {{"key", r.key},
            {"outcome", to_string(r.outcome)},
            {"status", r.status},
            {"stop_reason", r.stop_reason},
            {"message", r.message},
            {"value", or_null(r.value)},
            {"bound", or_null(r.bound)},
            {"work", r.work},
            {"solver_seconds", r.solver_seconds},
            {"statistics", r.statistics},
            {"trace", trace},
            {"measures", to_json(r.measures)},
            {"command", r.command},
            {"provenance", r.provenance}};
}

Record record_from(const json& j, const std::string& source) {
    try {
        Record r;
        r.key = j.at("key");
        r.outcome = outcome_from(j.at("outcome"));
        r.status = j.at("status");
        r.stop_reason = j.at("stop_reason");
        r.message = j.at("message");
        r.value = integer_or_nothing(j.at("value"));
        r.bound = integer_or_nothing(j.at("bound"));
        r.work = j.at("work");
        r.solver_seconds = j.at("solver_seconds");
        r.statistics = j.at("statistics").get<std::map<std::string, double>>();
        for (const json& p : j.at("trace")) {
            r.trace.push_back(
                {p.at(0), p.at(1), integer_or_nothing(p.at(2)), integer_or_nothing(p.at(3))});
        }
        r.measures = measures_from(j.at("measures"));
        r.command = j.at("command");
        r.provenance = j.at("provenance");
        return r;
    } catch (const json::exception& error) {
        throw labeling::InputError(source + ": no record of a run: " + error.what());
    }
}

}  // namespace experiment

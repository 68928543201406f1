// Everything that was measured, in SQLite. The records' files are what a run leaves behind; the
// database is made from them and can be made again. One transaction a run, so that a killed runner
// leaves a run whole or not at all; the key is unique, so that nothing is there twice.
#include "experiment/database.h"

#include <sqlite3.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

#include "experiment/execute.h"
#include "experiment/hash.h"
#include "labeling/errors.h"

namespace experiment {
namespace {

using nlohmann::json;

constexpr int kBusyMilliseconds = 10000;

constexpr const char* kSchema = R"sql(
BEGIN IMMEDIATE;
CREATE TABLE IF NOT EXISTS campaign (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS problems (
    id INTEGER PRIMARY KEY, name TEXT UNIQUE NOT NULL, file TEXT NOT NULL, grp TEXT NOT NULL,
    hash TEXT NOT NULL, labels INTEGER, conflicts INTEGER, bonuses INTEGER, rules INTEGER,
    units_per_one REAL, optimum INTEGER, tags TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS solvers (
    id INTEGER PRIMARY KEY, name TEXT UNIQUE NOT NULL, solver TEXT, program TEXT,
    options TEXT NOT NULL, start TEXT, threads INTEGER, seconds REAL, ticks INTEGER, gap REAL,
    memory_mib INTEGER, disk_mib INTEGER);
CREATE TABLE IF NOT EXISTS jobs (
    key TEXT PRIMARY KEY, position INTEGER UNIQUE NOT NULL, problem INTEGER NOT NULL,
    solver INTEGER NOT NULL, seed INTEGER NOT NULL, renaming INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS provenance (id TEXT PRIMARY KEY, content TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS runs (
    key TEXT PRIMARY KEY, outcome TEXT NOT NULL, status TEXT, stop_reason TEXT, message TEXT,
    value INTEGER, bound INTEGER, work INTEGER, solver_seconds REAL, statistics TEXT NOT NULL,
    wall_seconds REAL, user_seconds REAL, system_seconds REAL, peak_mib REAL,
    instructions INTEGER, load REAL, processor INTEGER, exit_code INTEGER, signal INTEGER,
    started_at TEXT, command TEXT, instance TEXT, seed TEXT, provenance TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS trace (
    run TEXT NOT NULL, position INTEGER NOT NULL, seconds REAL, work INTEGER, value INTEGER,
    bound INTEGER, PRIMARY KEY (run, position)) WITHOUT ROWID;
COMMIT;
)sql";

/// One statement; parameters in order, then step by step.
class Statement {
public:
    Statement(sqlite3* handle, const std::string& database, const char* text)
        : handle_(handle), database_(database) {
        if (sqlite3_prepare_v2(handle, text, -1, &statement_, nullptr) != SQLITE_OK) fail();
    }
    ~Statement() { sqlite3_finalize(statement_); }
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;

    Statement& put(const std::string& text) {
        return check(sqlite3_bind_text(statement_, ++at_, text.data(),
                                       static_cast<int>(text.size()), SQLITE_TRANSIENT));
    }
    Statement& put(std::int64_t value) {
        return check(sqlite3_bind_int64(statement_, ++at_, value));
    }
    Statement& put(int value) { return put(std::int64_t{value}); }
    Statement& put(std::size_t value) { return put(static_cast<std::int64_t>(value)); }
    Statement& put(double value) { return check(sqlite3_bind_double(statement_, ++at_, value)); }
    template <class Number>
    Statement& put(const std::optional<Number>& value) {
        return value ? put(*value) : check(sqlite3_bind_null(statement_, ++at_));
    }

    /// True while there is a row.
    bool step() {
        const int code = sqlite3_step(statement_);
        if (code != SQLITE_ROW && code != SQLITE_DONE) fail();
        return code == SQLITE_ROW;
    }
    void run() {
        while (step()) {
        }
        sqlite3_reset(statement_);
        at_ = 0;
    }
    std::string text(int column) const {
        const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
        return bytes == nullptr ? "" : std::string(bytes);
    }
    std::int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
    double real(int column) const { return sqlite3_column_double(statement_, column); }
    std::optional<std::int64_t> integer_or_nothing(int column) const {
        if (sqlite3_column_type(statement_, column) == SQLITE_NULL) return std::nullopt;
        return integer(column);
    }

private:
    Statement& check(int code) {
        if (code != SQLITE_OK) fail();
        return *this;
    }
    [[noreturn]] void fail() const {
        throw labeling::InputError(database_ + ": " + sqlite3_errmsg(handle_));
    }
    sqlite3* handle_;
    const std::string& database_;
    sqlite3_stmt* statement_ = nullptr;
    int at_ = 0;
};

/// Rolled back unless committed.
class Transaction {
public:
    Transaction(sqlite3* handle, const std::string& name) : handle_(handle), name_(name) {
        Statement(handle_, name_, "BEGIN IMMEDIATE").run();
    }
    ~Transaction() {
        if (!is_done_) sqlite3_exec(handle_, "ROLLBACK", nullptr, nullptr, nullptr);
    }
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit() {
        Statement(handle_, name_, "COMMIT").run();
        is_done_ = true;
    }

private:
    sqlite3* handle_;
    const std::string& name_;
    bool is_done_ = false;
};

void store_trace(Statement& into, const Record& record) {
    for (std::size_t k = 0; k < record.trace.size(); ++k) {
        const TracePoint& p = record.trace[k];
        into.put(record.key).put(k).put(p.seconds).put(p.work).put(p.value).put(p.bound);
        into.run();
    }
}

std::map<std::string, std::vector<TracePoint>> traces(sqlite3* handle, const std::string& name) {
    std::map<std::string, std::vector<TracePoint>> result;
    Statement all(handle, name,
                  "SELECT run, seconds, work, value, bound FROM trace ORDER BY run, position");
    while (all.step()) {
        result[all.text(0)].push_back(
            {all.real(1), all.integer(2), all.integer_or_nothing(3), all.integer_or_nothing(4)});
    }
    return result;
}

Measures measures_from(const Statement& row, int first) {
    Measures m;
    m.wall_seconds = row.real(first);
    m.user_seconds = row.real(first + 1);
    m.system_seconds = row.real(first + 2);
    m.peak_mib = row.real(first + 3);
    m.instructions = row.integer_or_nothing(first + 4);
    m.load = row.real(first + 5);
    m.processor = static_cast<int>(row.integer(first + 6));
    m.exit_code = static_cast<int>(row.integer(first + 7));
    m.signal = static_cast<int>(row.integer(first + 8));
    m.started_at = row.text(first + 9);
    return m;
}

[[noreturn]] void fail_to_open(sqlite3* handle, const std::string& name) {
    throw labeling::InputError(name + ": " +
                               (handle != nullptr ? sqlite3_errmsg(handle) : "no memory"));
}

/// As in the address of a file.
std::string percent_encoded(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                              (c >= '0' && c <= '9') || c == '/' || c == '.' || c == '-' ||
                              c == '_';
        char code[4];
        std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned char>(c));
        result += is_plain ? std::string(1, c) : std::string(code);
    }
    return result;
}

}  // namespace

Database::Database(const std::filesystem::path& folder, Access access)
    : name_((folder / "campaign.sqlite").string()) {
    try {
        access == Access::Write ? open_to_write() : open_to_read();
    } catch (...) {
        sqlite3_close(handle_);
        throw;
    }
}

void Database::open_to_write() {
    if (sqlite3_open(name_.c_str(), &handle_) != SQLITE_OK) fail_to_open(handle_, name_);
    sqlite3_busy_timeout(handle_, kBusyMilliseconds);
    Statement(handle_, name_, "PRAGMA journal_mode = WAL").run();
    Statement(handle_, name_, "PRAGMA synchronous = NORMAL").run();
    if (sqlite3_exec(handle_, kSchema, nullptr, nullptr, nullptr) != SQLITE_OK) {
        fail_to_open(handle_, name_);
    }
}

/// A reader of a write-ahead log wants to write beside it, too. Where that cannot be, and there is
/// no log, the file is whole and nobody's: it is read as it is.
void Database::open_to_read() {
    namespace fs = std::filesystem;
    std::error_code error;
    if (!fs::exists(name_, error)) return;
    std::vector<std::string> ways{"?mode=ro"};
    const auto log = fs::file_size(name_ + "-wal", error);
    if (error || log == 0) ways.emplace_back("?immutable=1");
    for (const std::string& way : ways) {
        sqlite3_close(handle_);
        handle_ = nullptr;
        const std::string address = "file:" + percent_encoded(name_) + way;
        constexpr int kFlags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
        if (sqlite3_open_v2(address.c_str(), &handle_, kFlags, nullptr) != SQLITE_OK) continue;
        sqlite3_busy_timeout(handle_, kBusyMilliseconds);
        const int code =
            sqlite3_exec(handle_, "SELECT 1 FROM sqlite_schema", nullptr, nullptr, nullptr);
        if (code != SQLITE_OK) continue;
        Statement tables(handle_, name_, "SELECT 1 FROM sqlite_schema WHERE name = 'runs'");
        if (tables.step()) return;
        break;  // its maker was killed before the tables were there
    }
    if (sqlite3_errcode(handle_) != SQLITE_OK && sqlite3_errcode(handle_) != SQLITE_DONE) {
        fail_to_open(handle_, name_);
    }
    sqlite3_close(handle_);
    handle_ = nullptr;
}

Database::~Database() { sqlite3_close(handle_); }

void Database::store_plan(const Plan& plan) {
    Transaction transaction(handle_, name_);
    for (const char* table : {"campaign", "problems", "solvers", "jobs"}) {
        Statement(handle_, name_, (std::string("DELETE FROM ") + table).c_str()).run();
    }
    Statement about(handle_, name_, "INSERT INTO campaign VALUES (?, ?)");
    const std::map<std::string, std::string> facts{{"name", plan.name},
                                                   {"description", plan.description},
                                                   {"config_file", plan.config_file},
                                                   {"config", plan.config_text}};
    for (const auto& [key, value] : facts) about.put(key).put(value).run();
    Statement problem(handle_, name_,
                      "INSERT INTO problems VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (std::size_t k = 0; k < plan.problems.size(); ++k) {
        const PlannedProblem& p = plan.problems[k];
        problem.put(k).put(p.name).put(p.file).put(p.group).put(p.hash).put(p.labels);
        problem.put(p.conflicts).put(p.bonuses).put(p.rules).put(p.units_per_one).put(p.optimum);
        problem.put(json(p.tags).dump()).run();
    }
    Statement solver(handle_, name_,
                     "INSERT INTO solvers VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (std::size_t k = 0; k < plan.solvers.size(); ++k) {
        const SolverConfig& s = plan.solvers[k];
        solver.put(k).put(s.name).put(s.solver).put(s.program).put(json(s.options).dump());
        solver.put(s.start).put(s.threads).put(s.limits.seconds).put(s.limits.ticks);
        solver.put(s.limits.gap).put(s.limits.memory_mib).put(s.limits.disk_mib).run();
    }
    Statement job(handle_, name_, "INSERT INTO jobs VALUES (?, ?, ?, ?, ?, ?)");
    for (std::size_t k = 0; k < plan.jobs.size(); ++k) {
        const Job& j = plan.jobs[k];
        job.put(j.key).put(k).put(j.problem).put(j.solver);
        job.put(static_cast<std::int64_t>(j.seed)).put(static_cast<std::int64_t>(j.renaming));
        job.run();
    }
    transaction.commit();
}

bool Database::store(const Record& r) {
    Transaction transaction(handle_, name_);
    const std::string origin = r.provenance.dump();
    const std::string origin_id = content_hash(origin);
    Statement(handle_, name_, "INSERT OR IGNORE INTO provenance VALUES (?, ?)")
        .put(origin_id)
        .put(origin)
        .run();
    Statement run(handle_, name_,
                  "INSERT OR IGNORE INTO runs VALUES "
                  "(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
    const Measures& m = r.measures;
    run.put(r.key).put(to_string(r.outcome)).put(r.status).put(r.stop_reason).put(r.message);
    run.put(r.value).put(r.bound).put(r.work).put(r.solver_seconds).put(json(r.statistics).dump());
    run.put(m.wall_seconds).put(m.user_seconds).put(m.system_seconds).put(m.peak_mib);
    run.put(m.instructions).put(m.load).put(m.processor).put(m.exit_code).put(m.signal);
    run.put(m.started_at).put(r.command).put(r.provenance.value("instance", std::string()));
    run.put(r.provenance.value("seed", std::string())).put(origin_id).run();
    const bool is_new = sqlite3_changes(handle_) > 0;
    if (is_new) {
        Statement trace(handle_, name_, "INSERT INTO trace VALUES (?, ?, ?, ?, ?, ?)");
        store_trace(trace, r);
    }
    transaction.commit();
    return is_new;
}

void Database::erase(const std::string& key) {
    Transaction transaction(handle_, name_);
    Statement(handle_, name_, "DELETE FROM trace WHERE run = ?").put(key).run();
    Statement(handle_, name_, "DELETE FROM runs WHERE key = ?").put(key).run();
    transaction.commit();
}

std::set<std::string> Database::finished_keys() const {
    std::set<std::string> keys;
    if (handle_ == nullptr) return keys;
    Statement all(handle_, name_, "SELECT key FROM runs");
    while (all.step()) keys.insert(all.text(0));
    return keys;
}

std::vector<Record> Database::records() const {
    if (handle_ == nullptr) return {};
    auto points = traces(handle_, name_);
    std::vector<Record> result;
    Statement all(handle_, name_,
                  "SELECT runs.key, outcome, status, stop_reason, message, value, bound, work, "
                  "solver_seconds, statistics, command, content, wall_seconds, user_seconds, "
                  "system_seconds, peak_mib, instructions, load, processor, exit_code, signal, "
                  "started_at FROM runs JOIN provenance ON runs.provenance = provenance.id "
                  "ORDER BY runs.key");
    while (all.step()) {
        Record r;
        r.key = all.text(0);
        r.outcome = outcome_from(all.text(1));
        r.status = all.text(2);
        r.stop_reason = all.text(3);
        r.message = all.text(4);
        r.value = all.integer_or_nothing(5);
        r.bound = all.integer_or_nothing(6);
        r.work = all.integer(7);
        r.solver_seconds = all.real(8);
        r.statistics = json::parse(all.text(9)).get<std::map<std::string, double>>();
        r.command = all.text(10);
        r.provenance = json::parse(all.text(11));
        r.measures = measures_from(all, 12);
        r.trace = std::move(points[r.key]);
        result.push_back(std::move(r));
    }
    return result;
}

CampaignRuns load_campaign(const std::filesystem::path& folder) {
    CampaignRuns campaign;
    campaign.plan = read_plan(folder);
    std::map<std::string, Record> by_key;
    for (Record& r : Database(folder, Database::Access::Read).records()) {
        const std::string key = r.key;
        by_key.emplace(key, std::move(r));
    }
    for (const Job& job : campaign.plan.jobs) {
        const auto it = by_key.find(job.key);
        campaign.records.push_back(it == by_key.end() ? std::nullopt
                                                      : std::optional<Record>(it->second));
    }
    return campaign;
}

}  // namespace experiment

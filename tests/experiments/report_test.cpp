// The report as a reader gets it: files, their form, and what stops it.
#include "experiment/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "experiment/plots.h"
#include "experiment/programs.h"
#include "experiment/report_csv.h"
#include "experiment/report_html.h"
#include "experiment/report_markdown.h"
#include "experiment/report_numbers.h"
#include "experiments/synthetic_campaign.h"
#include "labeling/text_file.h"
#include "labeling_mip/external_process.h"
#include "report/html_check.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;
using labeling::read_text_file;
using test::CampaignBuilder;

/// Sets SCALEFCN_PYTHON for a while.
class PythonIs {
public:
    explicit PythonIs(const std::string& python) {
        if (const char* before = std::getenv("SCALEFCN_PYTHON")) before_ = before;
        ::setenv("SCALEFCN_PYTHON", python.c_str(), 1);
    }
    ~PythonIs() {
        if (before_) {
            ::setenv("SCALEFCN_PYTHON", before_->c_str(), 1);
        } else {
            ::unsetenv("SCALEFCN_PYTHON");
        }
    }
    PythonIs(const PythonIs&) = delete;
    PythonIs& operator=(const PythonIs&) = delete;

private:
    std::optional<std::string> before_;
};

constexpr const char* kNoPython = "/nonexistent/python3";

bool has_matplotlib() {
    const labeling::ScratchFolder scratch;
    labeling::ProgramRun run;
    run.words = {python_for_plots(), "-c", "import matplotlib"};
    run.folder = scratch.path();
    run.output_file = scratch.path() / "out";
    run.error_file = scratch.path() / "err";
    const auto outcome = labeling::run_program(run);
    return outcome.end == labeling::ProgramEnd::Exited && outcome.exit_code == 0;
}

std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream in(entry.path(), std::ios::binary);
        files[fs::relative(entry.path(), folder).string()] = {std::istreambuf_iterator<char>(in),
                                                              {}};
    }
    return files;
}

CampaignRuns everything() {
    CampaignRuns runs = test::whole_campaign(7);
    test::add_study(runs, 3);
    return runs;
}

/// Reads RFC 4180.
std::vector<std::vector<std::string>> parsed_csv(const std::string& text) {
    std::vector<std::vector<std::string>> rows;
    std::vector<std::string> row;
    std::string field;
    bool is_quoted = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const char c = text[k];
        if (is_quoted) {
            if (c == '"' && k + 1 < text.size() && text[k + 1] == '"') {
                field += text[++k];
            } else if (c == '"') {
                is_quoted = false;
            } else {
                field += c;
            }
        } else if (c == '"') {
            is_quoted = true;
        } else if (c == ',' || c == '\n') {
            row.push_back(field);
            field.clear();
            if (c == '\n') rows.push_back(std::exchange(row, {}));
        } else if (c != '\r') {
            field += c;
        }
    }
    return rows;
}

TEST(Report, WithoutMatplotlibItIsCompleteButForThePlots) {
    const PythonIs none(kNoPython);
    const labeling::ScratchFolder scratch;
    const fs::path folder = scratch.path() / "report";
    const ReportResult result = write_report(everything(), folder);
    EXPECT_TRUE(result.contradictions.empty());
    EXPECT_NE(result.note.find("scripts/setup_experiments.sh"), std::string::npos) << result.note;
    for (const char* name : {"report.md", "report.html", "runs.csv", "problems.csv", "pairs.csv",
                             "study.csv", "plots.json"}) {
        EXPECT_TRUE(fs::exists(folder / name)) << name;
    }
    EXPECT_FALSE(fs::exists(folder / "plots"));
    const std::string text = read_text_file(folder / "report.md");
    EXPECT_NE(text.find("setup\\_experiments.sh"), std::string::npos);
    EXPECT_EQ(text.find("]("), std::string::npos) << "a picture that is not there";
    for (const fs::path& file : result.files) EXPECT_TRUE(fs::exists(file)) << file;
}

TEST(Report, SaysWhatAReaderCouldNotGuess) {
    const PythonIs none(kNoPython);
    test::CampaignBuilder builder;
    const std::size_t first = builder.solver("first"), close = builder.solver("close"),
                      heuristic = builder.solver("heuristic");
    for (int k = 0; k < 3; ++k) {
        const std::string name = std::string("mesh") + std::to_string(k);
        const std::size_t p = builder.problem(name, name);
        builder.optimal(p, first, 100, 0.5 + k);
        Record& unproven = builder.feasible(p, close, 100, 101, 0.25 + k);
        unproven.stop_reason = "finished";
        unproven.message = "near enough";
        builder.feasible(p, heuristic, 90, std::nullopt, 1);
    }
    const labeling::ScratchFolder scratch;
    write_report(builder.runs, scratch.path() / "report");
    const std::string text = read_text_file(scratch.path() / "report" / "report.md");
    // An exact solver that ends by itself without a proof: why, and how many runs.
    EXPECT_NE(text.find("close: 3 runs ended before any limit, without an exact proof, and count "
                        "as unsolved. It says: near enough."),
              std::string::npos);
    EXPECT_EQ(text.find("first: "), std::string::npos);
    // The start of a program is in its times.
    EXPECT_NE(text.find("| first | 3 | **3** | **1.36"), std::string::npos);
    EXPECT_NE(text.find("| 3 | 0.500 to 2.50 |"), std::string::npos);
    EXPECT_NE(text.find("| 0 | – |"), std::string::npos);
    EXPECT_NE(text.find("There are 3 groups here"), std::string::npos);
    // Times of a heuristic are no ratios.
    const auto rows = parsed_csv(read_text_file(scratch.path() / "report" / "pairs.csv"));
    const auto ratio = static_cast<std::size_t>(
        std::find(rows[0].begin(), rows[0].end(), "time_b_over_a") - rows[0].begin());
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_NE(rows[1].at(ratio), "");
    EXPECT_EQ(rows[2].at(ratio), "");
    EXPECT_EQ(rows[3].at(ratio), "");
}

TEST(Report, APythonWithoutMatplotlibIsToldApartFromAFailure) {
    const labeling::ScratchFolder scratch;
    const auto script = [&](const std::string& body) {
        const fs::path file = scratch.path() / "python";
        std::ofstream(file) << "#!/bin/sh\n" << body << "\n";
        fs::permissions(file, fs::perms::owner_all);
        return file.string();
    };
    const CampaignRuns runs = test::whole_campaign(1, 2, 2);
    {
        const PythonIs bare(
            script("echo \"ModuleNotFoundError: No module named 'matplotlib'\" >&2"
                   "\nexit 1"));
        const std::string note = write_report(runs, scratch.path() / "report").note;
        EXPECT_NE(note.find("has no matplotlib"), std::string::npos) << note;
    }
    const PythonIs broken(script("echo 'the disk is gone' >&2\nexit 1"));
    const std::string note = write_report(runs, scratch.path() / "report").note;
    EXPECT_NE(note.find("the disk is gone"), std::string::npos) << note;
}

/// Where a report of everything is made once for the tests that look at it from different sides.
class WholeReport : public testing::Test {
protected:
    static void SetUpTestSuite() {
        scratch_ = std::make_unique<labeling::ScratchFolder>();
        CampaignRuns runs = everything();
        runs.plan.description = "Names that <b>break</b> pages & \"quotes\"";
        runs.plan.problems[0].name = "<script>alert(1)</script>";
        result_ = write_report(runs, folder());
    }
    static void TearDownTestSuite() { scratch_.reset(); }
    static fs::path folder() { return scratch_->path() / "report"; }

    static std::unique_ptr<labeling::ScratchFolder> scratch_;
    static ReportResult result_;
};

std::unique_ptr<labeling::ScratchFolder> WholeReport::scratch_;
ReportResult WholeReport::result_;

TEST(Report, EqualRecordsGiveEqualBytes) {
    const labeling::ScratchFolder scratch;
    CampaignRuns runs = test::whole_campaign(4, 3, 2);
    // Two solvers are enough to have every kind of plot but one.
    for (std::size_t j = 0; j < runs.plan.jobs.size(); ++j) {
        if (runs.plan.jobs[j].solver > 1) runs.records[j].reset();
    }
    for (const char* name : {"a/report", "b/report"}) write_report(runs, scratch.path() / name);
    const auto a = contents(scratch.path() / "a"), b = contents(scratch.path() / "b");
    ASSERT_EQ(a.size(), b.size());
    for (const auto& [name, text] : a) {
        ASSERT_TRUE(b.contains(name)) << name;
        EXPECT_TRUE(b.at(name) == text) << name << " differs";
    }
}

TEST(Report, EqualRecordsGiveEqualTables) {
    const PythonIs none(kNoPython);
    const labeling::ScratchFolder scratch;
    for (const char* name : {"a/report", "b/report"}) {
        write_report(everything(), scratch.path() / name);
    }
    EXPECT_EQ(contents(scratch.path() / "a"), contents(scratch.path() / "b"));
}

TEST_F(WholeReport, HtmlIsWellFormedAndNeedsNothingFromOutside) {
    const std::string html = read_text_file(folder() / "report.html");
    const auto check = fcn::test::check_html(html);
    for (const std::string& problem : check.problems) ADD_FAILURE() << problem;
    EXPECT_EQ(html.find("http"), std::string::npos);
    EXPECT_EQ(html.find("<script>alert"), std::string::npos);
    std::size_t tables = 0, pictures = 0;
    for (const auto& tag : check.tags) {
        EXPECT_NE(tag.name, "link");
        tables += tag.name == "table" && !tag.is_closing;
        const auto source = tag.attributes.find("src");
        if (source == tag.attributes.end()) continue;
        ++pictures;
        EXPECT_TRUE(source->second.starts_with("data:image/svg+xml;base64,"));
    }
    EXPECT_GT(tables, 10u);
    EXPECT_EQ(pictures > 10, has_matplotlib());
}

TEST_F(WholeReport, PicturesAreThereWhereMatplotlibIs) {
    if (!has_matplotlib()) GTEST_SKIP() << "no matplotlib: scripts/setup_experiments.sh";
    EXPECT_EQ(result_.note, "");
    const auto data = nlohmann::json::parse(read_text_file(folder() / "plots.json"));
    std::set<std::string> names;
    for (const auto& figure : data.at("figures")) {
        const std::string name = figure.at("name");
        EXPECT_TRUE(names.insert(name).second) << name << " twice";
        for (const char* ending : {".svg", ".pdf"}) {
            EXPECT_GT(fs::file_size(folder() / "plots" / (name + ending)), 1000u) << name;
        }
        EXPECT_FALSE(figure.at("x").at("label").get<std::string>().empty()) << name;
    }
    for (const char* name : {"profile", "cactus", "gap-over-time", "gap-best", "gap-bound",
                             "time-size", "ablation-time", "scatter-1", "study-coverage"}) {
        EXPECT_TRUE(names.contains(name)) << name;
    }
}

TEST(Report, ContradictionsStopItInRed) {
    const labeling::ScratchFolder scratch;
    const fs::path folder = scratch.path() / "report";
    CampaignBuilder b;
    const auto p = b.problem("cursed");
    const auto honest = b.solver("honest"), liar = b.solver("liar");
    b.feasible(p, honest, 100, {}, 1);
    {
        const PythonIs none(kNoPython);
        EXPECT_TRUE(write_report(b.runs, folder).contradictions.empty());
    }
    ASSERT_TRUE(fs::exists(folder / "runs.csv"));
    b.optimal(p, liar, 90, 1);
    const ReportResult result = write_report(b.runs, folder);
    ASSERT_EQ(result.contradictions.size(), 1u);
    const auto files = contents(folder);
    ASSERT_EQ(files.size(), 2u) << "tables of an earlier report are still there";
    for (const auto& [name, text] : files) {
        EXPECT_NE(text.find("honest on cursed"), std::string::npos) << name;
        EXPECT_NE(text.find("liar on cursed"), std::string::npos) << name;
        EXPECT_EQ(text.find("PAR10"), std::string::npos) << name;
    }
    EXPECT_NE(files.at("report.html").find("class=\"alarm\""), std::string::npos);
    EXPECT_TRUE(fcn::test::check_html(files.at("report.html")).problems.empty());
}

TEST(Report, WrongRunsAreListedAndDoNotStopIt) {
    const PythonIs none(kNoPython);
    const labeling::ScratchFolder scratch;
    CampaignBuilder b;
    const auto p = b.problem("p");
    b.optimal(p, b.solver("honest"), 100, 1);
    Record& wrong = b.run(p, b.solver("liar"), Outcome::Wrong, 1);
    wrong.bound = 3;
    wrong.message = "wrong labels: labels 3 and 4 conflict";
    const ReportResult result = write_report(b.runs, scratch.path() / "report");
    EXPECT_TRUE(result.contradictions.empty());
    const std::string text = read_text_file(scratch.path() / "report" / "report.md");
    EXPECT_NE(text.find("## Wrong answers"), std::string::npos);
    EXPECT_NE(text.find("liar on p, seed 1: wrong labels: labels 3 and 4 conflict"),
              std::string::npos);
}

TEST(Report, SaysWhatIsMissingAndHowToGetIt) {
    const PythonIs none(kNoPython);
    const labeling::ScratchFolder scratch;
    write_report(everything(), scratch.path() / "report");
    const std::string text = read_text_file(scratch.path() / "report" / "report.md");
    EXPECT_NE(text.find("1 run is not yet made"), std::string::npos);
    EXPECT_NE(text.find("apt-get install glpk-utils"), std::string::npos);
    EXPECT_NE(text.find("GRB_LICENSE_FILE="), std::string::npos);
    EXPECT_NE(text.find("scalefcn-experiment run synthetic.toml -o DIR"), std::string::npos);
    EXPECT_NE(text.find("## Where quick loses"), std::string::npos);
    EXPECT_NE(text.find("## With our start"), std::string::npos);
    EXPECT_NE(text.find("0123abcd"), std::string::npos);
}

TEST(Report, FailuresAreListedWithWhatTheySaid) {
    const PythonIs none(kNoPython);
    const labeling::ScratchFolder scratch;
    CampaignBuilder b;
    const auto s = b.solver("fragile");
    b.run(b.problem("p"), s, Outcome::Crash, 1).message = "died of signal 11";
    b.run(b.problem("q"), s, Outcome::OutOfMemory, 1).message = "over its memory limit";
    std::ofstream(scratch.path() / "solver_versions.json") << "{\"glpk\": \"GLPK 5.0\"}";
    write_report(b.runs, scratch.path() / "report");
    const std::string text = read_text_file(scratch.path() / "report" / "report.md");
    EXPECT_NE(text.find("fragile: runs on 1 problem crashed: p. It says: died of signal 11."),
              std::string::npos);
    EXPECT_NE(text.find("ran out of memory: q"), std::string::npos);
    EXPECT_NE(text.find("| glpk | GLPK 5.0 |"), std::string::npos);
}

TEST(Report, InstructionsStandBesideSecondsWhereTheyAreCounted) {
    const PythonIs none(kNoPython);
    const labeling::ScratchFolder scratch;
    CampaignBuilder b;
    b.optimal(b.problem("p"), b.solver("s"), 100, 1);
    write_report(b.runs, scratch.path() / "report");
    const fs::path file = scratch.path() / "report" / "report.md";
    EXPECT_EQ(read_text_file(file).find("instructions, geometric"), std::string::npos);
    b.runs.records[0]->measures.instructions = 12'300'000'000;
    write_report(b.runs, scratch.path() / "report");
    EXPECT_NE(read_text_file(file).find("instructions, geometric"), std::string::npos);
    EXPECT_NE(read_text_file(file).find("| 12.300 |"), std::string::npos);
}

TEST(Report, AnEmptyCampaignHasAReport) {
    const labeling::ScratchFolder scratch;
    CampaignBuilder b;
    b.job(b.problem("p"), b.solver("s"));
    EXPECT_TRUE(write_report(b.runs, scratch.path() / "report").contradictions.empty());
    const std::string html = read_text_file(scratch.path() / "report" / "report.html");
    EXPECT_TRUE(fcn::test::check_html(html).problems.empty());
    EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(Report, CsvHasARowARunAndReadsBack) {
    CampaignRuns runs = everything();
    runs.records[0]->message = "a \"quoted\", comma\nand line";
    const auto rows = parsed_csv(runs_csv(runs, compare_solvers(runs)));
    ASSERT_EQ(rows.size(), runs.plan.jobs.size() + 1);
    std::map<std::string, std::size_t> column;
    for (std::size_t k = 0; k < rows[0].size(); ++k) {
        EXPECT_TRUE(column.emplace(rows[0][k], k).second) << rows[0][k] << " twice";
    }
    for (std::size_t j = 0; j < runs.plan.jobs.size(); ++j) {
        const auto& row = rows[j + 1];
        ASSERT_EQ(row.size(), rows[0].size()) << "row " << j;
        EXPECT_EQ(row[column["run"]], runs.plan.jobs[j].key);
        EXPECT_EQ(row[column["problem"]], runs.plan.problems[runs.plan.jobs[j].problem].name);
        const auto& record = runs.records[j];
        EXPECT_EQ(row[column["outcome"]], record ? to_string(record->outcome) : "not-run");
        if (!record) continue;
        EXPECT_EQ(row[column["message"]], record->message);
        EXPECT_EQ(row[column["value"]], record->value ? std::to_string(*record->value) : "");
        const auto& tags = runs.plan.problems[runs.plan.jobs[j].problem].tags;
        EXPECT_EQ(row[column["tag_mesh"]], tags.at("mesh"));
    }
    const auto problems = parsed_csv(problems_csv(runs, compare_solvers(runs)));
    ASSERT_EQ(problems.size(), runs.plan.problems.size() + 1);
    for (const auto& row : problems) EXPECT_EQ(row.size(), problems[0].size());
}

TEST(Report, TablesAreRectangularInMarkdown) {
    const PythonIs none(kNoPython);
    const labeling::ScratchFolder scratch;
    CampaignRuns runs = everything();
    runs.plan.problems[0].name = "a|b";
    write_report(runs, scratch.path() / "report");
    std::ifstream in(scratch.path() / "report" / "report.md");
    std::size_t columns = 0, lines = 0;
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("|")) {
            columns = 0;
            continue;
        }
        std::size_t bars = 0;
        for (std::size_t k = 0; k < line.size(); ++k) {
            bars += line[k] == '|' && (k == 0 || line[k - 1] != '\\');
        }
        if (columns == 0) columns = bars;
        EXPECT_EQ(bars, columns) << line;
        ++lines;
    }
    EXPECT_GT(lines, 50u);
}

TEST(Report, Numbers) {
    EXPECT_EQ(seconds_text(0.12345), "0.123");
    EXPECT_EQ(seconds_text(12.345), "12.3");
    EXPECT_EQ(seconds_text(1234.5), "1234");
    EXPECT_EQ(seconds_text(std::nan("")), "–");
    EXPECT_EQ(percent_text(0), "0%");
    EXPECT_EQ(percent_text(0.01234), "1.23%");
    EXPECT_EQ(percent_text(1), "100%");
    EXPECT_EQ(percent_text(1e-9), "<0.001%");
    EXPECT_EQ(decimal_text(-0.0001, 2), "0.00");
    EXPECT_EQ(number_text(323.5), "323.5");
    EXPECT_EQ(number_text(0.0123), "0.012");
    EXPECT_EQ(number_text(0), "0");
    EXPECT_EQ(count_text(1234567), "1,234,567");
    EXPECT_EQ(count_text(-999), "-999");
    EXPECT_EQ(ratio_interval({2, 1.5, 3, true}), "2.00 [1.50, 3.00]");
    EXPECT_EQ(ratio_interval({2, 2, 2, false}), "2.00");
}

TEST(Report, Base64) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("\xff\xfe\xfd\x00"
                     "a"),
              "//79");
    EXPECT_EQ(base64(std::string("\xff\xfe\xfd\0a", 5)), "//79AGE=");
}

}  // namespace
}  // namespace experiment

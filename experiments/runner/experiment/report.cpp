// Puts the report together: one document of sections, written as Markdown and as HTML, beside CSV
// files and plots. Nothing in it depends on when or where it is made: equal records, equal bytes.
#include "experiment/report.h"

#include <fstream>
#include <map>
#include <set>

#include "experiment/comparison.h"
#include "experiment/plot_data.h"
#include "experiment/plots.h"
#include "experiment/report_csv.h"
#include "experiment/report_html.h"
#include "experiment/report_markdown.h"
#include "experiment/report_sections.h"
#include "experiment/study_comparison.h"
#include "labeling/text_file.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;

class ReportWriter {
public:
    explicit ReportWriter(const fs::path& folder) : folder_(folder) {
        std::error_code error;
        fs::create_directories(folder, error);
        if (error) throw labeling::InputError(folder.string() + ": " + error.message());
        // What an earlier report left must not stand beside this one.
        for (const char* name : {"runs.csv", "problems.csv", "pairs.csv", "study.csv", "plots.json",
                                 "report.md", "report.html"}) {
            fs::remove(folder / name, error);
        }
        fs::remove_all(folder / "plots", error);
    }

    void write(const std::string& name, const std::string& text) {
        labeling::write_text_file(folder_ / name, text);
        result.files.push_back(folder_ / name);
    }

    void write(const Document& document, const std::map<std::string, std::string>& plots) {
        std::set<std::string> names;
        for (const auto& [name, svg] : plots) names.insert(name);
        write("report.md", to_markdown(document, names));
        write("report.html", to_html(document, plots));
    }

    ReportResult result;

private:
    fs::path folder_;
};

Document alarm(const CampaignRuns& campaign, const std::vector<Contradiction>& contradictions) {
    Document document;
    document.title = campaign.plan.name;
    document.is_alarm = true;
    document.lead = std::to_string(contradictions.size()) +
                    (contradictions.size() == 1 ? " contradiction" : " contradictions") +
                    ": claims that cannot all be true. There is no comparison until they are "
                    "explained.";
    BulletList list;
    for (const Contradiction& contradiction : contradictions) {
        list.items.push_back(contradiction.text);
    }
    document.sections.push_back(
        {"Contradictions",
         "contradictions",
         {std::move(list),
          Paragraph{"A value is a fact: the runner evaluated the labels itself. A bound, an "
                    "optimality and an infeasibility are what a solver says. To look at a run: "
                    "scalefcn-experiment show DIR RUN."}}});
    return document;
}

/// What the runner found out of solvers that are programs, when the campaign began.
std::map<std::string, std::string> solver_versions_of(const fs::path& home) {
    std::map<std::string, std::string> versions;
    std::ifstream in(home / "solver_versions.json");
    const auto json = nlohmann::json::parse(in, nullptr, false);
    if (!json.is_object()) return versions;
    for (const auto& [name, version] : json.items()) {
        if (version.is_string()) versions[name] = version.get<std::string>();
    }
    return versions;
}

Document document_of(const ReportInput& input, const std::string& note) {
    Document document;
    document.title = input.campaign.plan.name;
    document.lead = input.campaign.plan.description.empty() ? "A comparison of labeling solvers."
                                                            : input.campaign.plan.description;
    add_overview(input, document);
    if (!note.empty()) document.sections.back().blocks.emplace_back(Paragraph{"There are " + note});
    add_study(input, document);
    add_exact_solvers(input, document);
    add_values(input, document);
    add_losses(input, document);
    add_pairs(input, document);
    add_starts(input, document);
    add_ablations(input, document);
    add_scaling(input, document);
    add_gaps_in_the_record(input, document);
    add_problems(input, document);
    add_method(input, document);
    return document;
}

ReportResult write_whole_report(const CampaignRuns& campaign, const fs::path& folder) {
    ReportWriter writer(folder);
    const Comparison comparison = compare_solvers(campaign);
    if (!comparison.check.contradictions.empty()) {
        for (const Contradiction& contradiction : comparison.check.contradictions) {
            writer.result.contradictions.push_back(contradiction.text);
        }
        writer.write(alarm(campaign, comparison.check.contradictions), {});
        return std::move(writer.result);
    }
    const fs::path home = fs::absolute(folder / "..").lexically_normal();
    const StudyComparison study = compare_studies(campaign, home);
    PlotData plots;
    add_solver_plots(campaign, comparison, plots);
    add_study_plots(campaign, study, plots);
    DrawnPlots drawn = draw_plots(plots.figures, folder);
    if (drawn.svg.empty()) plots.captions.clear();
    writer.result.note = drawn.note;
    writer.result.files.push_back(folder / "plots.json");
    for (const auto& [name, svg] : drawn.svg) {
        writer.result.files.push_back(folder / "plots" / (name + ".svg"));
        writer.result.files.push_back(folder / "plots" / (name + ".pdf"));
    }
    const auto versions = solver_versions_of(home);
    writer.write(document_of({campaign, comparison, study, plots, versions}, drawn.note),
                 drawn.svg);
    writer.write("runs.csv", runs_csv(campaign, comparison));
    writer.write("problems.csv", problems_csv(campaign, comparison));
    writer.write("pairs.csv", pairs_csv(campaign, comparison));
    if (!study.entries.empty()) writer.write("study.csv", study_csv(campaign, study));
    return std::move(writer.result);
}

}  // namespace

ReportResult write_report(const CampaignRuns& campaign, const fs::path& folder) {
    try {
        return write_whole_report(campaign, folder);
    } catch (const fs::filesystem_error& error) {
        throw labeling::InputError(error.what());
    }
}

}  // namespace experiment

#include "report/report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "decoded_picture.h"
#include "html_check.h"
#include "report/html.h"
#include "report/report_tables.h"

namespace fcn {
namespace {

const std::string kNastyName = "a<b>&\"c'</title><script>alert(1)</script>";
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Mesh tetrahedron() {
    Mesh mesh;
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
        mesh.add_vertex(p);
    const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    for (const auto& f : faces)
        mesh.add_face(VertexHandle(f[0]), VertexHandle(f[1]), VertexHandle(f[2]));
    return mesh;
}

FeatureCurveNetwork one_edge(bool is_adapted) {
    FeatureCurveNetwork network;
    network.nodes = {{{0, 0, 0}, {}}, {{1, 0, 0}, {}}};
    NetworkArc arc;
    arc.nodes = {0, 1};
    arc.samples = {{{0, 0, 0}, {}}, {{0.5, 0, 0}, {}}, {{1, 0, 0}, {}}};
    network.arcs.push_back(arc);
    if (!is_adapted) return network;
    network.scale = 1;
    network.segments.push_back({{0, 1}, 0, 0, 2, 3.5, false});
    DroppedPiece light, heavy;
    light.polyline = {{0, 0, 0}, {0, 1, 0}};
    light.reason = "short arc";
    light.weight = 1;
    heavy.polyline = {{0, 0, 0}, {0, 0, 2}};
    heavy.reason = "conflict";
    heavy.weight = 20;
    heavy.label = 4;
    heavy.blockers = {{0, 3, 1.5, "distance", 0.25}, {6}};
    heavy.margin = 2.5;
    network.dropped = {light, heavy};
    network.notes = {"note on <adapted>"};
    return network;
}

ScaleRecord scale_record() {
    ScaleRecord scale;
    scale.label = "2%";
    scale.rmin = 0.5;
    scale.adaptation.network = one_edge(true);
    scale.adaptation.report.coverage = 0.9876;
    scale.adaptation.report.is_optimal = true;
    scale.adaptation.report.seconds = 77.125;
    scale.adaptation.report.warnings = {"warning & more"};
    IterationReport iteration;
    iteration.iteration = 1;
    iteration.segments = 321;
    iteration.angle_conflicts = 654;
    iteration.value = 1234.5;
    iteration.bound = kNan;
    iteration.seconds = {{"solve", 66.25}};
    scale.adaptation.report.iterations = {iteration};
    scale.solvers = {{"iteration 1", "greedy", "feasible", 10, kNan, kNan, 0.5},
                     {"iteration 1", "auto", "optimal", 12.5, 12.5, 0, 55.75}};
    scale.remesh.mesh = tetrahedron();
    scale.remesh_quality = measure_triangles(scale.remesh.mesh);
    scale.has_remesh = true;
    return scale;
}

MeshRecord mesh_record(const std::string& name) {
    MeshRecord record;
    record.mesh.mesh = tetrahedron();
    record.mesh.name = name;
    record.initial = one_edge(false);
    record.method = "sharp";
    record.messages = {"repaired <something>"};
    record.scales = {scale_record()};
    return record;
}

class Report : public ::testing::Test {
protected:
    void SetUp() override {
        path_ = std::filesystem::temp_directory_path() /
                ("scalefcn_report_" + std::to_string(::getpid()) + ".html");
    }
    void TearDown() override { std::filesystem::remove(path_); }

    std::string written(const std::vector<MeshRecord>& meshes, const ReportOptions& options = {}) {
        write_report(path_, meshes, options);
        return read_file(path_);
    }

    std::filesystem::path path_;
};

std::vector<test::HtmlTag> tags_named(const test::HtmlCheck& check, const std::string& name) {
    std::vector<test::HtmlTag> found;
    for (const test::HtmlTag& tag : check.tags)
        if (tag.name == name && !tag.is_closing) found.push_back(tag);
    return found;
}

TEST_F(Report, IsWellFormed) {
    for (const std::string& name : {std::string("plain"), kNastyName}) {
        const auto check = test::check_html(written({mesh_record(name), mesh_record("second")}));
        EXPECT_TRUE(check.problems.empty()) << check.problems.front();
        EXPECT_EQ(tags_named(check, "script").size(), 0U);
        EXPECT_EQ(tags_named(check, "title").size(), 1U);
        EXPECT_NE(check.text.find(escape_html(name)), std::string::npos);
    }
}

TEST_F(Report, NeedsNothingFromOutside) {
    ReportOptions options;
    options.command = "scalefcn run part.stl --scales 2%";
    const std::string html = written({mesh_record("part")}, options);
    EXPECT_EQ(html.find("http:"), std::string::npos);
    EXPECT_EQ(html.find("https:"), std::string::npos);
    EXPECT_EQ(html.find("url("), std::string::npos);
    EXPECT_EQ(html.find("@import"), std::string::npos);
    const auto check = test::check_html(html);
    EXPECT_TRUE(tags_named(check, "link").empty());
    for (const test::HtmlTag& tag : check.tags) {
        const auto source = tag.attributes.find("src");
        if (source == tag.attributes.end()) continue;
        EXPECT_EQ(source->second.rfind("data:image/png;base64,", 0), 0U);
    }
    EXPECT_NE(check.text.find(options.command), std::string::npos);
}

std::string decode_base64(const std::string& text) {
    std::string bytes;
    unsigned group = 0, bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        const unsigned digit = c >= 'A' && c <= 'Z'   ? static_cast<unsigned>(c - 'A')
                               : c >= 'a' && c <= 'z' ? static_cast<unsigned>(c - 'a') + 26
                               : c >= '0' && c <= '9' ? static_cast<unsigned>(c - '0') + 52
                               : c == '+'             ? 62U
                                                      : 63U;
        group = (group << 6 | digit) & 0xffffff;
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(group >> bits & 255);
    }
    return bytes;
}

TEST_F(Report, PicturesAreThereWithAltTextAndDecode) {
    const auto check = test::check_html(written({mesh_record("part")}));
    const auto images = tags_named(check, "img");
    ASSERT_EQ(images.size(), 4U);  // initial; dropped, adapted, remesh
    for (const test::HtmlTag& image : images) {
        EXPECT_GT(image.attributes.at("alt").size(), 20U);
        const std::string source = image.attributes.at("src");
        const auto picture = test::decode_png(decode_base64(source.substr(source.find(',') + 1)));
        EXPECT_EQ(std::to_string(picture.width), image.attributes.at("width"));
        EXPECT_EQ(std::to_string(picture.height), image.attributes.at("height"));
    }
}

TEST_F(Report, AnchorsResolveAndIdsAreUnique) {
    const auto check = test::check_html(written({mesh_record("a"), mesh_record("b")}));
    std::set<std::string> ids;
    for (const test::HtmlTag& tag : check.tags) {
        const auto id = tag.attributes.find("id");
        if (id != tag.attributes.end()) {
            EXPECT_TRUE(ids.insert(id->second).second) << id->second;
        }
    }
    std::size_t links = 0;
    for (const test::HtmlTag& link : tags_named(check, "a")) {
        const std::string target = link.attributes.at("href");
        ASSERT_EQ(target[0], '#');
        EXPECT_TRUE(ids.count(target.substr(1))) << target;
        ++links;
    }
    EXPECT_GE(links, 3U);
}

TEST_F(Report, TablesHaveCaptionsAndScopedHeaders) {
    const auto check = test::check_html(written({mesh_record("part")}));
    EXPECT_EQ(tags_named(check, "table").size(), tags_named(check, "caption").size());
    EXPECT_GE(tags_named(check, "table").size(), 5U);
    for (const test::HtmlTag& header : tags_named(check, "th"))
        EXPECT_TRUE(header.attributes.count("scope"));
}

TEST_F(Report, NamesWhatItIsGiven) {
    const std::string text = test::check_html(written({mesh_record("part")})).text;
    for (const char* expected : {"part", "2%", "321", "654", "1234.500", "greedy", "12.500", "98.8",
                                 "short arc", "conflict", "warning &amp; more",
                                 "repaired &lt;something&gt;", "note on &lt;adapted&gt;", "45.0"})
        EXPECT_NE(text.find(expected), std::string::npos) << expected;
}

TEST_F(Report, TimingsCanBeLeftOut) {
    ReportOptions options;
    EXPECT_NE(written({mesh_record("part")}, options).find("55.75"), std::string::npos);
    options.has_timings = false;
    const std::string html = written({mesh_record("part")}, options);
    for (const char* seconds : {"55.75", "66.25", "77.1", "Seconds"})
        EXPECT_EQ(html.find(seconds), std::string::npos) << seconds;
}

TEST_F(Report, SameInputGivesSameBytes) {
    const std::string once = written({mesh_record("part")});
    EXPECT_EQ(once, written({mesh_record("part")}));
}

TEST_F(Report, RecordsWithoutResultsAreWritten) {
    MeshRecord bare = mesh_record("bare");
    bare.initial = {};
    bare.scales[0].adaptation = {};
    bare.scales[0].solvers.clear();
    bare.scales[0].has_remesh = false;
    const auto check = test::check_html(written({bare}));
    EXPECT_TRUE(check.problems.empty()) << check.problems.front();
    EXPECT_TRUE(test::check_html(written({})).problems.empty());
}

TEST_F(Report, ViolationsAreListedThoseThatCountFirst) {
    MeshRecord record = mesh_record("part");
    Violation exempt, counted;
    exempt.kind = counted.kind = ViolationKind::Angle;
    exempt.is_exempt = true;
    counted.first = 7;
    counted.second = 9;
    counted.measured = 0.5;  // 28.65 degrees
    record.scales[0].conformity.violations = {exempt, counted};
    record.scales[0].conformity.counted = 1;
    const HtmlTable table = violation_table(record.scales[0].conformity, 10);
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[0][1], "yes");
    EXPECT_EQ(table.rows[0][2], "7, 9");
    EXPECT_EQ(table.rows[0][3], "28.65\u00b0");
    EXPECT_EQ(violation_table(record.scales[0].conformity, 1).rows.size(), 1U);
    const std::string text = test::check_html(written({record})).text;
    EXPECT_NE(text.find("1 violation"), std::string::npos);
}

/// Widths of the pictures of one mesh in a report of `mesh_count`.
std::vector<std::string> picture_widths(std::size_t mesh_count) {
    fcn::Report report({}, mesh_count);
    report.add(mesh_record("part"));
    std::vector<std::string> widths;
    for (const test::HtmlTag& tag : tags_named(test::check_html(report.html()), "img"))
        widths.push_back(tag.attributes.at("width"));
    return widths;
}

TEST(ReportSpace, PicturesShrinkWithTheNumberOfMeshesAndThenGo) {
    const std::vector<std::string> one = picture_widths(1), many = picture_widths(60);
    ASSERT_EQ(one.size(), 4U);
    ASSERT_EQ(many.size(), 4U);
    for (const std::string& width : one) EXPECT_EQ(width, "840");
    for (const std::string& width : many) EXPECT_LT(std::stoi(width), 420);
    EXPECT_TRUE(picture_widths(100'000).empty());
}

TEST(ReportSpace, PageGrowsMeshByMeshAsIfWrittenAtOnce) {
    fcn::Report report({}, 2);
    report.add(mesh_record("first"));
    EXPECT_TRUE(test::check_html(report.html()).problems.empty());
    EXPECT_EQ(report.html().find(">second<"), std::string::npos);
    report.add(mesh_record("second"));
    const auto path = std::filesystem::temp_directory_path() /
                      ("scalefcn_report_at_once_" + std::to_string(::getpid()) + ".html");
    write_report(path, {mesh_record("first"), mesh_record("second")});
    EXPECT_EQ(report.html(), read_file(path));
    std::filesystem::remove(path);
}

TEST(ReportTables, WaysAreMeasuredSideBySideAndFailuresSaid) {
    ScaleRecord scale = scale_record();
    ComparisonRow plain, broken;
    plain.quality.faces = 77;
    plain.distance.hausdorff = 0.25;
    broken.failure = "ran out of luck";
    scale.compared = {{"Plain", plain}, {"Broken", broken}};
    const HtmlTable table = ways_table(scale, 2);
    ASSERT_EQ(table.rows.size(), 3U);
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
    EXPECT_EQ(table.rows[1][0], "Plain");
    EXPECT_EQ(table.rows[1][1], "77");
    EXPECT_EQ(table.rows[1][6], format_percent(0.125, 2));
    EXPECT_NE(table.rows[2][1].find("ran out of luck"), std::string::npos);
}

TEST(ReportTables, HeaviestDropsComeFirstWithTheirBlockers) {
    const HtmlTable table = heaviest_drops_table(one_edge(true), 10);
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[0][0], "conflict");
    EXPECT_EQ(table.rows[0][5], "5");  // labels from 1
    EXPECT_EQ(table.rows[0][6], "2.500");
    EXPECT_EQ(table.rows[0][7], "1 (distance, arc 3), 7");
    EXPECT_EQ(heaviest_drops_table(one_edge(true), 1).rows.size(), 1U);
}

TEST(ReportTables, RowsAreAsWideAsTheirHeaders) {
    const std::vector<MeshRecord> meshes{mesh_record("part")};
    const ScaleRecord& scale = meshes[0].scales[0];
    HtmlTable engineer = engineer_table();
    add_engineer_rows(meshes[0], engineer);
    for (const bool has_timings : {true, false}) {
        for (const HtmlTable& table :
             {engineer, ways_table(scale, 1), solver_table(scale, has_timings),
              iteration_table(scale, has_timings), reason_table(scale.adaptation.network),
              heaviest_drops_table(scale.adaptation.network, 5)}) {
            EXPECT_FALSE(table.rows.empty());
            for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
        }
    }
}

TEST(ReportTables, BestValueOfEachProblemStandsOut) {
    const HtmlTable table = solver_table(scale_record(), true);
    EXPECT_EQ(table.is_emphasized, (std::vector<bool>{false, true}));
}

TEST(Html, Base64MatchesTheStandard) {
    // RFC 4648, section 10.
    EXPECT_EQ(encode_base64(""), "");
    EXPECT_EQ(encode_base64("f"), "Zg==");
    EXPECT_EQ(encode_base64("fo"), "Zm8=");
    EXPECT_EQ(encode_base64("foo"), "Zm9v");
    EXPECT_EQ(encode_base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(encode_base64("\xff\xfe\xfd"), "//79");
}

TEST(Html, NumbersThatAreNoneBecomeDashes) {
    EXPECT_EQ(format_number(1.25, 1), "1.2");
    EXPECT_EQ(format_number(kNan, 2), "\u2013");
    EXPECT_EQ(format_percent(INFINITY), "\u2013");
    EXPECT_EQ(format_percent(0.1234, 1), "12.3\u00a0%");
    EXPECT_EQ(format_significant(123456.0), "1.235e+05");
}

TEST(Html, CheckerFindsWhatIsBroken) {
    for (const char* broken : {"<!DOCTYPE html>\n<p>", "<!DOCTYPE html>\n<b><i></b></i>", "<p></p>",
                               "<!DOCTYPE html>\n<p>a & b</p>", "<!DOCTYPE html>\n<p a=1></p>",
                               "<!DOCTYPE html>\n</p>", "<!DOCTYPE html>\n<p a=\"x\" a=\"y\"></p>"})
        EXPECT_FALSE(test::check_html(broken).problems.empty()) << broken;
    EXPECT_TRUE(test::check_html("<!DOCTYPE html>\n<p a=\"&lt;\">x</p>").problems.empty());
}

}  // namespace
}  // namespace fcn

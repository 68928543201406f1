// Detectors on the same parts at several resolutions and levels of noise:
//   detectors_noise_scale [--detectors sharp,vsa,crest] [--noise 0,0.1,0.2] [--faces 10000,100000]
//                         [--threads N] PART ...
// A part is the name of a built-in model or a mesh file, with its curves in NAME.cadedges.txt;
// without that file its sharp edges are taken for them, which says how much of them noise takes
// away. Models are made with about as many faces as asked for; meshes are refined by Loop
// subdivision, creases along their curves, until they have at least two thirds of that. Noise
// displaces every coordinate of every vertex, in mean edges. Prints a table: precision is the share
// of the found length within half a mean edge of the part's curves, recall the share of its curves
// of 40 degrees and more that have a found one that close; `length` is relative to those curves',
// `agreement` with the network of the resolution before: the smaller share of either's length
// within half an edge of the coarser mesh of the other. Seconds are processor seconds.

#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <map>
#include <sstream>

#include "features/crest.h"
#include "features/features.h"
#include "geometry/errors.h"
#include "known_curves.h"

namespace {

using namespace fcn;

struct Arguments {
    std::vector<std::string> detectors{"sharp", "vsa", "crest"};
    std::vector<double> noise{0, 0.1, 0.2};
    std::vector<int> faces{10000, 100000, 1000000};
    std::vector<std::string> parts;
    int threads = 1;
    int seed = 1;
};

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream in(text);
    for (std::string word; std::getline(in, word, ',');) words.push_back(word);
    return words;
}

Arguments parse(int argc, char** argv) {
    Arguments result;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word.rfind("--", 0) != 0) {
            result.parts.push_back(word);
            continue;
        }
        if (++i == argc) throw InputError(word + " needs a value");
        if (word == "--detectors") {
            result.detectors = split(argv[i]);
        } else if (word == "--noise") {
            result.noise.clear();
            for (const std::string& number : split(argv[i]))
                result.noise.push_back(std::stod(number));
        } else if (word == "--faces") {
            result.faces.clear();
            for (const std::string& number : split(argv[i]))
                result.faces.push_back(std::stoi(number));
        } else if (word == "--threads") {
            result.threads = std::stoi(argv[i]);
        } else if (word == "--seed") {
            result.seed = std::stoi(argv[i]);
        } else {
            throw InputError("unknown option " + word);
        }
    }
    if (result.parts.empty()) throw InputError("no part");
    return result;
}

FeatureCurveNetwork detect(const std::string& detector, const LoadedMesh& mesh, int threads) {
    if (detector == "sharp") return detect_sharp(mesh);
    if (detector == "vsa") {
        VsaOptions options;
        options.threads = threads;
        return detect_vsa(mesh, options);
    }
    if (detector == "crest") {
        CrestOptions options;
        options.threads = threads;
        return detect_crest(mesh, options);
    }
    throw InputError("unknown detector " + detector);
}

KnownPart part_of_size(const std::string& name, int faces) {
    if (name.find('.') == std::string::npos) return model_part(name, faces);
    KnownPart part = cad_part(name);
    while (3 * part.triangles.size() < 2 * static_cast<std::size_t>(faces)) part = refined(part);
    return part;
}

struct Previous {
    FeatureCurveNetwork network;
    double edge = 0;
};

void run(const std::string& name, const Arguments& arguments) {
    std::map<std::pair<std::string, double>, Previous> previous;
    std::size_t last_size = 0;
    for (int faces : arguments.faces) {
        const KnownPart part = part_of_size(name, faces);
        if (part.triangles.size() == last_size) continue;  // the mesh itself is finer than asked
        last_size = part.triangles.size();
        const KnownCurves known =
            name == "superellipse-torus" ? crest_circles() : known_curves(part);
        const double edge = part.mean_edge();
        for (double noise : arguments.noise) {
            const LoadedMesh mesh =
                noisy_mesh(part, noise, static_cast<std::uint64_t>(arguments.seed));
            for (const std::string& detector : arguments.detectors) {
                const std::clock_t start = std::clock();
                FeatureCurveNetwork found = detect(detector, mesh, arguments.threads);
                const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
                const CurveScore s = score(found, known, 0.5 * edge);
                Previous& before = previous[{detector, noise}];
                std::string agreement;
                if (before.edge > 0) {
                    char text[32];
                    std::snprintf(text, sizeof text, "%.3f",
                                  std::min(share_near(found, before.network, 0.5 * before.edge),
                                           share_near(before.network, found, 0.5 * before.edge)));
                    agreement = text;
                }
                const double truth = known.required.total_length();
                std::printf(
                    "| %s | %zu | %.0f | %s | %.3f | %.3f | %.3f | %zu / %zu | %s | %.2f |\n",
                    part.name.c_str(), part.triangles.size(), 100 * noise, detector.c_str(),
                    s.precision, s.recall, truth > 0 ? s.length / truth : s.length, s.curve_count,
                    known.required.arcs.size(), agreement.c_str(), seconds);
                std::fflush(stdout);
                before = {std::move(found), edge};
            }
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const Arguments arguments = parse(argc, argv);
        std::printf(
            "| part | faces | noise %% | detector | precision | recall | length | curves / known |"
            " agreement | seconds |\n|---|---|---|---|---|---|---|---|---|---|\n");
        for (const std::string& part : arguments.parts) run(part, arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;
    }
    return 0;
}

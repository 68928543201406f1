#pragma once

#include <string>
#include <vector>

#include "app/crest_arguments.h"
#include "features/features.h"

namespace CLI {
class App;
}

namespace fcn::app {

/// Where the initial network comes from: a detector, or a file.
struct DetectionArguments {
    std::string method = "auto";  ///< or several joined by +
    std::string fuse_distance;    ///< empty = the default of combine_networks()
    std::string network_path;     ///< import instead of detecting; only where offered

    double sharp_angle_degrees = 40;
    double low_angle_degrees = 18;
    std::string sign = "both";
    bool is_plain = false;        ///< sharp edges by a threshold alone
    std::string min_length = "";  ///< empty = keep all

    int patch_count = 100;
    int vsa_iterations = 40;
    double min_patch_area = 0;
    bool is_unstraightened = false;
    std::string seed_faces_path;

    CrestArguments crest;

    std::string wires_path;   ///< empty = links between loose ends
    std::string wire_length;  ///< empty = the default of WireOptions
    double wire_snap_percent = 0.5;
    double wire_attraction = 5;
    double wire_anisotropy = 15;

    bool is_symmetric = false;      ///< look for symmetries and orbits
    std::string symmetry_distance;  ///< empty = the default of SymmetryOptions
    double symmetry_coverage = 0.6;

    std::string boundary = "keep";
    double corner_angle_degrees = 45;
};

/// Options of the detectors; `--method auto` is offered too. Ranges are checked while parsing.
void add_detection_arguments(CLI::App& parser, DetectionArguments& arguments);

struct Detection {
    FeatureCurveNetwork network;
    std::string method;  ///< what `auto` decided for, "import" for a file
    std::vector<std::string> messages;
};

/// The initial network with boundaries and label borders. An imported network must fit the mesh
/// (InputError otherwise).
Detection detect_network(const LoadedMesh& mesh, const DetectionArguments& arguments, int threads);

}  // namespace fcn::app

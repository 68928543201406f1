// Guided bilateral filtering of face normals (Zhang, Deng, Zhang, Bouaziz, Liu, Guided mesh normal
// filtering, 2015): a normal becomes the mean of those around it, by area, distance and by how much
// their *guidance* agrees with its own. The guidance of a face is the mean normal of the flattest
// patch that contains it, a patch being a face and all faces that touch it: next to a crease the
// flattest patch lies on one side, so that the mean does not reach across, and a mean over thirteen
// faces is far less noisy than the normals between which a plain bilateral filter has to tell.
//
// Departures: a patch is as flat as the length of its mean normal says, instead of the largest
// difference of two normals in it, which one wild face decides. The noise is measured, as a length,
// since it is the vertices that are displaced: the flatter quarter of the places says how far. All
// thresholds follow it, by the size of the faces at hand, so that ribs and holes of small faces
// beside large ones are kept, and a face on a rib that is narrower than a patch guides itself;
// slivers, whose normals noise turns anywhere, count less and follow those around them. Few
// rounds: more make stairs of fillets. Wider patches were worse, on fine meshes as well.

#include "features/normal_filter.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace fcn {
namespace {

constexpr double kAgreement = 2.5;      // of a face with its guidance, in standard deviations
constexpr double kFlatSpreads = 2.5;    // of noise, at most, in a patch that guides
constexpr double kRangeNoises = 2.5;    // standard deviation of the weights by normals, in noise
constexpr double kHeightShare = 0.75;   // of a face: displacement over it is its normal's
constexpr double kSliver = 0.25;        // height over longest edge
constexpr double kHalfWeight = 3;       // height over displacement at which a normal counts half
constexpr double kBlind = 2;            // the same, up to which a face takes any guidance
constexpr double kDistanceEdges = 1.5;  // standard deviation of the weights by distance

struct Patch {
    Vec3 mean = Vec3::Zero();
    double size = 0;  ///< edge length, about: the root of a face's mean area
    double spread = 2;
};

class NormalFilter {
public:
    NormalFilter(const MeshArrays& arrays, const std::vector<bool>& is_noisy_face,
                 const NormalFilterOptions& options)
        : arrays_(arrays),
          options_(options),
          at_vertex_(faces_of_vertices(arrays)),
          is_near_(is_noisy_face),
          normals_(arrays.normals),
          patches_(arrays.face_count()),
          flattest_(arrays.face_count()),
          guidance_(arrays.normals),
          weights_(arrays.areas),
          centroids_(arrays.face_count()),
          arena_(std::max(1, options.threads)) {
        for (int f = 0; f < arrays.face_count(); ++f) {
            centroids_[f] = arrays.centroid(f);
            if (!is_noisy_face[f]) continue;
            noisy_.push_back(f);
            for (int v : arrays.face_vertices[f]) {
                for (const int* g = at_vertex_.begin(v); g != at_vertex_.end(v); ++g)
                    is_near_[*g] = true;
            }
        }
        for (int f = 0; f < arrays.face_count(); ++f) {
            if (is_near_[f]) near_.push_back(f);
        }
    }

    FilteredNormals run() {
        list_neighbors();
        find_patches();
        measure_noise();
        weigh_faces();
        find_patches();
        if (!(displacement_ > 0)) return {arrays_.normals, 0, 0};
        for (int round = 0; round < options_.rounds; ++round) {
            if (round > 0) find_patches();
            for_each(near_, [&](int f) { guidance_[f] = guidance(f); });
            std::vector<Vec3> next = normals_;
            for_each(noisy_, [&](int f) { next[f] = filtered(f); });
            normals_ = std::move(next);
        }
        for_each(near_, [&](int f) { patches_[f] = patch(f); });
        const double residual = lower_quartile([&](int f) { return 2 * patches_[f].spread; });
        return {std::move(normals_), displacement_, residual};
    }

private:
    template <typename Work>
    void for_each(const std::vector<int>& faces, Work work) {
        arena_.execute([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), 512),
                              [&](const tbb::blocked_range<std::size_t>& range) {
                                  for (std::size_t i = range.begin(); i < range.end(); ++i)
                                      work(faces[i]);
                              });
        });
    }

    /// The faces that touch a face, itself first.
    void touching(int face, std::vector<int>& faces) const {
        faces.assign(1, face);
        for (int v : arrays_.face_vertices[face]) {
            for (const int* g = at_vertex_.begin(v); g != at_vertex_.end(v); ++g)
                if (std::find(faces.begin(), faces.end(), *g) == faces.end()) faces.push_back(*g);
        }
    }

    void list_neighbors() {
        std::vector<std::vector<int>> lists(arrays_.face_count());
        for_each(near_, [&](int f) {
            touching(f, lists[f]);
            std::erase_if(lists[f], [&](int g) { return !is_near_[g]; });
        });
        neighbors_.offsets.assign(1, 0);
        for (const std::vector<int>& list : lists) {
            neighbors_.values.insert(neighbors_.values.end(), list.begin(), list.end());
            neighbors_.offsets.push_back(static_cast<int>(neighbors_.values.size()));
        }
    }

    template <typename Use>
    void for_touching(int face, Use use) const {
        for (const int* g = neighbors_.begin(face); g != neighbors_.end(face); ++g) use(*g);
    }

    void find_patches() {
        for_each(near_, [&](int f) { patches_[f] = patch(f); });
        for_each(near_, [&](int f) { flattest_[f] = flattest(f); });
    }

    Patch patch(int face) const {
        Patch result;
        double area = 0, weight = 0;
        int count = 0;
        for_touching(face, [&](int g) {
            ++count;
            result.mean += weights_[g] * normals_[g];
            area += arrays_.areas[g];
            weight += weights_[g];
        });
        result.size = std::sqrt(area / count);
        const double norm = result.mean.norm();
        if (!(norm > 0)) return result;
        result.spread = 1 - norm / weight;
        result.mean /= norm;
        return result;
    }

    /// Of the patches that contain a face.
    int flattest(int face) const {
        int best = face;
        for_touching(face, [&](int g) {
            if (patches_[g].spread < patches_[best].spread) best = g;
        });
        return best;
    }

    template <typename Value>
    double lower_quartile(Value value) const {
        std::vector<double> values;
        for (int f : noisy_) values.push_back(std::max(0.0, value(f)));
        const auto quarter = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
        std::nth_element(values.begin(), quarter, values.end());
        return *quarter;
    }

    /// How far vertices are displaced, from the spread of normals where the surface is flat.
    void measure_noise() {
        displacement_ = lower_quartile([&](int f) {
            const Patch& patch = patches_[flattest_[f]];
            return std::sqrt(2 * std::max(0.0, patch.spread)) * patch.size;
        });
    }

    double longest_edge(int face) const {
        double longest = 1e-300;
        for (int e : arrays_.face_edges[face]) longest = std::max(longest, arrays_.edge_length(e));
        return longest;
    }

    double height(int face) const { return 2 * arrays_.areas[face] / longest_edge(face); }

    bool is_sliver(int face) const { return height(face) < kSliver * longest_edge(face); }

    /// Areas, less for slivers so thin that their normals say little.
    void weigh_faces() {
        for (int f : near_) {
            if (!is_sliver(f)) continue;
            const double certainty = kHeightShare * height(f) / std::max(1e-300, displacement_);
            weights_[f] *= 1 / (1 + std::pow(kHalfWeight / std::max(1e-150, certainty), 2));
        }
    }

    /// Standard deviation of a patch's normals by noise, in radians.
    double noise_of(const Patch& patch) const {
        return displacement_ / std::max(1e-300, patch.size);
    }

    /// The normal of the flattest patch, if it is as flat as noise allows and the face can lie on
    /// it; its own on ribs narrower than any patch.
    Vec3 guidance(int face) const {
        const Patch& patch = patches_[flattest_[face]];
        if (is_sliver(face) && height(face) <= kBlind * displacement_) return patch.mean;
        if (patch.spread > kFlatSpreads * 0.5 * std::pow(noise_of(patch), 2)) return normals_[face];
        const double deviation = (patch.mean - normals_[face]).norm();
        const bool is_agreeing =
            deviation * kHeightShare * height(face) <= kAgreement * displacement_;
        return is_agreeing ? patch.mean : normals_[face];
    }

    Vec3 filtered(int face) const {
        double edge = 1e-300;
        for (int e : arrays_.face_edges[face]) edge += arrays_.edge_length(e) / 3;
        const double range = std::min(options_.range, kRangeNoises * noise_of(patches_[face]));
        const double by_distance = 0.5 / std::pow(kDistanceEdges * edge, 2);
        const double by_normal = 0.5 / std::pow(range, 2);
        Vec3 sum = Vec3::Zero();
        for_touching(face, [&](int g) {
            const double distance = (centroids_[g] - centroids_[face]).squaredNorm();
            const double difference = (guidance_[g] - guidance_[face]).squaredNorm();
            sum += weights_[g] * std::exp(-by_distance * distance - by_normal * difference) *
                   normals_[g];
        });
        const double norm = sum.norm();
        return norm > 0 ? Vec3(sum / norm) : normals_[face];
    }

    const MeshArrays& arrays_;
    const NormalFilterOptions& options_;
    IndexRows at_vertex_, neighbors_;

    std::vector<bool> is_near_;  ///< noisy, or touching such a face: patches are known
    std::vector<int> noisy_, near_;
    std::vector<Vec3> normals_;
    std::vector<Patch> patches_;
    std::vector<int> flattest_;  ///< patch with this face
    double displacement_ = 0;    ///< of vertices by noise
    std::vector<Vec3> guidance_;
    std::vector<double> weights_;  ///< of normals
    std::vector<Vec3> centroids_;
    tbb::task_arena arena_;
};

}  // namespace

FilteredNormals filtered_normals(const MeshArrays& arrays, const std::vector<bool>& is_noisy_face,
                                 const NormalFilterOptions& options) {
    if (std::none_of(is_noisy_face.begin(), is_noisy_face.end(), [](bool is) { return is; }))
        return {arrays.normals, 0, 0};
    return NormalFilter(arrays, is_noisy_face, options).run();
}

}  // namespace fcn

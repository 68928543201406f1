// A cross of angle a is the complex number u = e^(4ia) (Knoeppel, Crane, Pinkall, Schroeder 2013,
// "Globally optimal direction fields"), so that smoothness and guides are quadratic:
//   E(u) = sum over links s |u_g - e^(4ir) u_f|^2 + sum over guides w |u_f - e^(4ia)|^2.
// The minimum of E alone shrinks far from guides and is too willing to jump there. So diffusion
// and normalisation take turns (Viertel, Osting 2019, "An approach to quad meshing based on
// harmonic cross-valued maps and the Ginzburg-Landau theory"; with shrinking times, Palmer, Bommes,
// Solomon 2020), which moves singularities apart and cancels pairs. The last time is that of one
// quad: what happens below it is for the merging of singularities. Components without any guide
// begin with inverse iterations from a random field.
#include "meshing/field_smoothing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

namespace fcn {
namespace {

using Complex = std::complex<double>;
using Field = Eigen::VectorXcd;

constexpr double kLeastLength = 1e-6;  ///< of a number before it has no direction
/// Diffusion times, in squares of a quad's edge.
constexpr double kTimes[] = {16, 4, 1};

class FieldSmoother {
public:
    FieldSmoother(const FaceConnection& connection, const std::vector<FieldGuide>& guides,
                  const FieldSmoothingOptions& options)
        : connection_(connection), options_(options) {
        const auto n = static_cast<Eigen::Index>(connection.areas.size());
        for (const double area : connection.areas) total_area_ += area;
        target_ = Field::Zero(n);
        matrix_.resize(n, n);
        std::vector<Eigen::Triplet<Complex>> entries;
        for (Eigen::Index f = 0; f < n; ++f) entries.emplace_back(f, f, 0.0);
        for (const FaceLink& link : connection.links) {
            entries.emplace_back(link.from, link.from, link.stiffness);
            entries.emplace_back(link.to, link.to, link.stiffness);
            const Complex turn = std::polar(link.stiffness, 4 * link.rotation);
            if (link.to > link.from)
                entries.emplace_back(link.to, link.from, -turn);
            else
                entries.emplace_back(link.from, link.to, -std::conj(turn));
        }
        for (const FieldGuide& guide : guides) {
            entries.emplace_back(guide.face, guide.face, guide.weight);
            target_[guide.face] += std::polar(guide.weight, 4 * guide.angle);
        }
        matrix_.setFromTriplets(entries.begin(), entries.end());
        solver_.analyzePattern(matrix_);
    }

    bool run() {
        std::mt19937_64 random(options_.seed);
        field_.resize(target_.size());
        for (Eigen::Index f = 0; f < field_.size(); ++f)
            field_[f] =
                std::polar(1.0, static_cast<double>(random() >> 11) * 0x1p-53 * 6.283185307179586);
        // Mass so small that it only keeps the matrix regular.
        if (!set_time(1e3 * total_area_)) return false;
        for (int i = 0; i < options_.start_rounds; ++i) diffuse();
        const double square = options_.edge_length * options_.edge_length;
        for (const double time : kTimes) {
            if (!set_time(time * square)) return false;
            for (int i = 0; i < options_.rounds; ++i) diffuse();
        }
        return true;
    }

    std::vector<double> angles() const {
        std::vector<double> result;
        for (Eigen::Index f = 0; f < field_.size(); ++f) result.push_back(std::arg(field_[f]) / 4);
        return result;
    }

private:
    bool set_time(double time) {
        masses_.resize(target_.size());
        for (Eigen::Index f = 0; f < masses_.size(); ++f)
            masses_[f] = connection_.areas[static_cast<std::size_t>(f)] / time;
        Eigen::SparseMatrix<Complex> shifted = matrix_;
        for (Eigen::Index f = 0; f < masses_.size(); ++f) shifted.coeffRef(f, f) += masses_[f];
        solver_.factorize(shifted);
        return solver_.info() == Eigen::Success;
    }

    /// One step of diffusion, then unit length.
    void diffuse() {
        const Field right = (masses_.array() * field_.array()).matrix() + target_;
        const Field next = solver_.solve(right);
        const double largest = next.cwiseAbs().maxCoeff();
        for (Eigen::Index f = 0; f < field_.size(); ++f) {
            const double length = std::abs(next[f]);
            if (length > kLeastLength * largest) field_[f] = next[f] / length;
        }
    }

    const FaceConnection& connection_;
    FieldSmoothingOptions options_;
    double total_area_ = 0;
    Eigen::SparseMatrix<Complex> matrix_;
    Field target_, field_;
    Eigen::VectorXd masses_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<Complex>> solver_;
};

}  // namespace

std::vector<double> smooth_field(const FaceConnection& connection,
                                 const std::vector<FieldGuide>& guides,
                                 const FieldSmoothingOptions& options) {
    FieldSmoother smoother(connection, guides, options);
    if (connection.areas.empty() || !smoother.run()) return {};
    return smoother.angles();
}

}  // namespace fcn

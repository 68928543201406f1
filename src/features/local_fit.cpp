// Curvatures and their derivatives by local polynomial fits (Yoshizawa, Belyaev, Seidel 2005,
// section 2): around every vertex the surface is a height over its tangent plane, a cubic fitted by
// weighted least squares to the vertices near by. From the cubic's coefficients the curvatures and
// their derivatives along the principal directions follow in closed form, also where the tangent
// plane was not quite right:
//     kappa = h(t, t),  e = (z_ttt - 3 h(t, t) z_l z_lt) / W   for a direction t of unit length,
// with h the second fundamental form of the graph z and W = sqrt(1 + |grad z|^2).
//
// Departures: the normals of the vertices give no further rows, which the paper takes from
// Goldfeather and Interrante (2004): normals of a mesh are wrong by the square of its edge length,
// third derivatives from them by a share of the squared curvature that no refinement lowers, and on
// fine tori that showed as lines. The neighbourhood is a ball of some local edge lengths instead of
// a number of rings (rings of an irregular mesh are ragged, which shows in third derivatives),
// weighted by a Gaussian; it is what is connected to the vertex inside the ball, turned away from
// it by less than 70 degrees, and not beyond a barrier. The cubic has a constant term, so noise of
// the vertex itself counts no more than that of others. The normals that tilt the local frames are
// averaged over a quarter of the radius: a cubic over a tilted plane is another cubic, and
// neighbours would not agree. The covariance of the fit gives every vertex the standard error of
// its results.

#include "features/local_fit.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace fcn {
namespace {

constexpr int kTerms = 10;
constexpr int kLeastNeighbors = 12;
constexpr int kMostNeighbors = 4096;
constexpr double kSpread = 0.5;                  // standard deviation of the weights, in radii
constexpr double kLeastFacing = 0.342;           // cosine of 70 degrees
constexpr double kNormalRoundsPerSquare = 0.06;  // smoothing of the frames, over a quarter radius
constexpr double kMostNormalRounds = 30;
constexpr double kLeastPivot = 1e-7;  // relative; below it the fit is not determined

using Row = Eigen::Matrix<double, kTerms, 1>;
using Normal = Eigen::Matrix<double, kTerms, kTerms>;
using Lanes = Eigen::Array2d;

/// Powers of u and v in each term of the cubic; a term is u^a v^b / (a! b!).
constexpr int kPowerU[kTerms] = {0, 1, 0, 2, 1, 0, 3, 2, 1, 0};
constexpr int kPowerV[kTerms] = {0, 0, 1, 0, 1, 2, 0, 1, 2, 3};
constexpr double kFactorial[] = {1, 1, 2, 6};

/// Sums of weight * value * u^a v^b over the neighbours for a + b <= Degree, two neighbours at a
/// time. The normal equations of a polynomial hold nothing else: 28 sums instead of 55 products.
template <int Degree>
class Moments {
public:
    void add(const Lanes& u, const Lanes& v, Lanes weight) {
        Lanes* sum = sums_.data();
        for (int a = 0; a <= Degree; ++a) {
            Lanes term = weight;
            for (int b = 0; b <= Degree - a; ++b) {
                *sum++ += term;
                term *= v;
            }
            weight *= u;
        }
    }
    double operator()(int a, int b) const {
        const Lanes& sum = sums_[static_cast<std::size_t>(a * (Degree + 1) - a * (a - 1) / 2 + b)];
        return sum[0] + sum[1];
    }

private:
    static constexpr int kCount = (Degree + 1) * (Degree + 2) / 2;
    std::array<Lanes, kCount> sums_ = zeros();
    static std::array<Lanes, kCount> zeros() {
        std::array<Lanes, kCount> result;
        result.fill(Lanes::Zero());
        return result;
    }
};

/// Vertices near by, in the local frame, in units of the radius. Even in number, the last may weigh
/// nothing.
struct Neighborhood {
    std::vector<double> u, v, z, weight;
    int count = 0;

    void clear() {
        for (auto* row : {&u, &v, &z, &weight}) row->clear();
        count = 0;
    }
    void pad() {
        count = static_cast<int>(u.size());
        if (count % 2 == 0) return;
        for (auto* row : {&u, &v, &z, &weight}) row->push_back(0);
    }
};

/// The normal equations. The residuals have the weighted sum of squares
/// squares - 2 c.right + c.matrix c.
struct Equations {
    Normal matrix = Normal::Zero();
    Row right = Row::Zero();
    double squares = 0;
    double weight = 0;

    explicit Equations(const Neighborhood& near) {
        Moments<6> moments;
        Moments<3> values;
        Lanes square = Lanes::Zero();
        for (std::size_t i = 0; i < near.u.size(); i += 2) {
            const Lanes u = lanes(near.u, i), v = lanes(near.v, i), w = lanes(near.weight, i);
            const Lanes z = lanes(near.z, i);
            moments.add(u, v, w);
            values.add(u, v, w * z);
            square += w * z * z;
        }
        squares = square.sum();
        weight = moments(0, 0);
        for (int i = 0; i < kTerms; ++i) {
            right[i] = factor(i) * values(kPowerU[i], kPowerV[i]);
            for (int k = 0; k <= i; ++k) {
                matrix(i, k) = matrix(k, i) =
                    factor(i) * factor(k) *
                    moments(kPowerU[i] + kPowerU[k], kPowerV[i] + kPowerV[k]);
            }
        }
    }

private:
    static Lanes lanes(const std::vector<double>& row, std::size_t i) {
        return Lanes(row[i], row[i + 1]);
    }
    static double factor(int term) {
        return 1 / (kFactorial[kPowerU[term]] * kFactorial[kPowerV[term]]);
    }
};

/// What a thread keeps between fits.
struct Workspace {
    std::vector<int> mark;
    std::vector<int> queue;
    Neighborhood near;
    int round = 0;
};

struct Frame {
    Vec3 u, v, normal;
};

Frame frame_of(const Vec3& normal) {
    int smallest = 0;
    normal.cwiseAbs().minCoeff(&smallest);
    const Vec3 u = normal.cross(Vec3::Unit(smallest)).normalized();
    return {u, normal.cross(u), normal};
}

/// Principal curvatures and derivatives of the height's graph at the origin; `c` are its
/// coefficients in units of the radius, and heights are counted inwards, so that convex is > 0.
class GraphCurvature {
public:
    explicit GraphCurvature(const Row& c) {
        gradient_ << c[1], c[2];
        hessian_ << c[3], c[4], c[4], c[5];
        cubic_ << c[6], c[7], c[8], c[9];
        w_ = std::sqrt(1 + gradient_.squaredNorm());
        const Eigen::Matrix2d first =
            Eigen::Matrix2d::Identity() + gradient_ * gradient_.transpose();
        // With first = L L^T, directions t = L^-T s of unit s have unit length on the surface.
        const Eigen::Matrix2d inverse_lower =
            first.llt().matrixL().solve(Eigen::Matrix2d::Identity());
        const Eigen::Matrix2d form = inverse_lower * hessian_ * inverse_lower.transpose() / w_;
        const double mean = 0.5 * (form(0, 0) + form(1, 1));
        const double half = 0.5 * (form(0, 0) - form(1, 1));
        const double spread = std::hypot(half, form(0, 1));
        const double angle = 0.5 * std::atan2(form(0, 1), half);
        curvature = {mean + spread, mean - spread};
        const Eigen::Vector2d larger(std::cos(angle), std::sin(angle));
        direction[0] = inverse_lower.transpose() * larger;
        direction[1] = inverse_lower.transpose() * Eigen::Vector2d(-larger.y(), larger.x());
    }

    double derivative(int which) const {
        const Eigen::Vector2d& t = direction[which];
        const double third =
            cubic_[0] * t.x() * t.x() * t.x() + 3 * cubic_[1] * t.x() * t.x() * t.y() +
            3 * cubic_[2] * t.x() * t.y() * t.y() + cubic_[3] * t.y() * t.y() * t.y();
        return (third - 3 * curvature[which] * gradient_.dot(hessian_ * t) / w_) / w_;
    }

    Vec3 lifted(int which, const Frame& frame) const {
        const Eigen::Vector2d& t = direction[which];
        const Vec3 lifted = t.x() * frame.u + t.y() * frame.v - gradient_.dot(t) * frame.normal;
        return lifted.normalized();
    }

    std::array<double, 2> curvature{};
    std::array<Eigen::Vector2d, 2> direction;

private:
    Eigen::Vector2d gradient_;
    Eigen::Matrix2d hessian_;
    Eigen::Vector4d cubic_;
    double w_ = 1;
};

class VertexFitter {
public:
    VertexFitter(const LocalFitter& fitter, const MeshArrays& arrays,
                 const std::vector<Vec3>& smooth_normals, const LocalFitOptions& options)
        : fitter_(fitter), arrays_(arrays), smooth_normals_(smooth_normals), options_(options) {}

    VertexFit fit(int vertex, Workspace& work) const {
        VertexFit result;
        const double edge = fitter_.edge_length_at(vertex);
        result.radius = options_.radius > 0 ? options_.radius : options_.rings * edge;
        const Vec3& normal = smooth_normals_[vertex];
        if (fitter_.is_on_barrier(vertex) || !(edge > 0) || normal.isZero()) return result;
        const Frame frame = frame_of(normal);
        gather(vertex, frame, result.radius, work);
        if (work.near.count < kLeastNeighbors) return result;
        const Equations equations(work.near);
        const Eigen::LDLT<Normal> solver(equations.matrix);
        const Row pivots = solver.vectorD();
        if (!(pivots.minCoeff() > kLeastPivot * pivots.maxCoeff())) return result;
        const Row coefficients = solver.solve(equations.right);
        const GraphCurvature graph(coefficients);
        describe(graph, frame, result);
        measure_errors(solver, coefficients, graph, equations, work.near.count, result);
        result.is_valid = true;
        return result;
    }

private:
    void gather(int vertex, const Frame& frame, double radius, Workspace& work) const {
        work.mark.resize(arrays_.points.size(), 0);
        work.queue.assign(1, vertex);
        work.near.clear();
        work.mark[vertex] = ++work.round;
        const Vec3& center = arrays_.points[vertex];
        const IndexRows& rows = fitter_.neighbors();
        for (std::size_t head = 0; head < work.queue.size(); ++head) {
            const int v = work.queue[head];
            add(frame, (arrays_.points[v] - center) / radius, work.near);
            if (fitter_.is_on_barrier(v)) continue;
            for (const int* n = rows.begin(v); n != rows.end(v); ++n) {
                if (work.mark[*n] == work.round) continue;
                work.mark[*n] = work.round;
                if ((arrays_.points[*n] - center).squaredNorm() > radius * radius) continue;
                const bool is_facing = fitter_.is_on_barrier(*n) ||
                                       smooth_normals_[*n].dot(frame.normal) >= kLeastFacing;
                if (is_facing && work.queue.size() < kMostNeighbors) work.queue.push_back(*n);
            }
        }
        work.near.pad();
    }

    static void add(const Frame& frame, const Vec3& offset, Neighborhood& near) {
        near.u.push_back(offset.dot(frame.u));
        near.v.push_back(offset.dot(frame.v));
        near.z.push_back(-offset.dot(frame.normal));
        near.weight.push_back(std::exp(-offset.squaredNorm() / (2 * kSpread * kSpread)));
    }

    static void describe(const GraphCurvature& graph, const Frame& frame, VertexFit& result) {
        const double r = result.radius;
        result.kappa_max = graph.curvature[0] / r;
        result.kappa_min = graph.curvature[1] / r;
        result.e_max = graph.derivative(0) / (r * r);
        result.e_min = graph.derivative(1) / (r * r);
        result.direction_max = graph.lifted(0, frame);
        result.direction_min = graph.lifted(1, frame);
    }

    /// Residuals of the heights times what the fit makes of a unit of them.
    static void measure_errors(const Eigen::LDLT<Normal>& solver, const Row& c,
                               const GraphCurvature& graph, const Equations& equations, int count,
                               VertexFit& result) {
        const double squares =
            equations.squares - 2 * c.dot(equations.right) + c.dot(equations.matrix * c);
        const double variance =
            std::max(0.0, squares) / equations.weight * count / std::max(1, count - kTerms);
        double kappa = 0, e = 0;
        for (const Eigen::Vector2d& t : graph.direction) {
            Row second = Row::Zero(), third = Row::Zero();
            second.segment<3>(3) << t.x() * t.x(), 2 * t.x() * t.y(), t.y() * t.y();
            third.segment<4>(6) << t.x() * t.x() * t.x(), 3 * t.x() * t.x() * t.y(),
                3 * t.x() * t.y() * t.y(), t.y() * t.y() * t.y();
            kappa = std::max(kappa, second.dot(solver.solve(second)));
            e = std::max(e, third.dot(solver.solve(third)));
        }
        result.kappa_error = std::sqrt(variance * kappa) / result.radius;
        result.e_error = std::sqrt(variance * e) / (result.radius * result.radius);
    }

    const LocalFitter& fitter_;
    const MeshArrays& arrays_;
    const std::vector<Vec3>& smooth_normals_;
    LocalFitOptions options_;
};

/// Weights after Max (1999), exact on spheres.
void add_corner_normals(const MeshArrays& arrays, int face, std::vector<Vec3>& normals) {
    const std::array<int, 3>& corners = arrays.face_vertices[face];
    for (int i = 0; i < 3; ++i) {
        const Vec3& p = arrays.points[corners[i]];
        const Vec3 a = arrays.points[corners[(i + 1) % 3]] - p;
        const Vec3 b = arrays.points[corners[(i + 2) % 3]] - p;
        const double squares = a.squaredNorm() * b.squaredNorm();
        if (squares > 0) normals[corners[i]] += a.cross(b) / squares;
    }
}

}  // namespace

LocalFitter::LocalFitter(const MeshArrays& arrays, const std::vector<bool>& is_barrier_edge)
    : arrays_(arrays), is_on_barrier_(arrays.vertex_count(), false) {
    for (int e = 0; e < arrays.edge_count() && !is_barrier_edge.empty(); ++e) {
        if (!is_barrier_edge[e]) continue;
        for (int v : arrays.edge_vertices[e]) is_on_barrier_[v] = true;
    }
    connect();
    measure_edges();
    normals_.assign(arrays.vertex_count(), Vec3::Zero());
    for (int f = 0; f < arrays.face_count(); ++f) add_corner_normals(arrays, f, normals_);
    for (Vec3& normal : normals_) normal.normalize();
}

void LocalFitter::connect() {
    const int count = arrays_.vertex_count();
    neighbors_.offsets.assign(count + 1, 0);
    for (const auto& [a, b] : arrays_.edge_vertices) {
        ++neighbors_.offsets[a + 1];
        ++neighbors_.offsets[b + 1];
    }
    for (int v = 0; v < count; ++v) neighbors_.offsets[v + 1] += neighbors_.offsets[v];
    neighbors_.values.resize(neighbors_.offsets.back());
    std::vector<int> next(neighbors_.offsets.begin(), neighbors_.offsets.end() - 1);
    for (const auto& [a, b] : arrays_.edge_vertices) {
        neighbors_.values[next[a]++] = b;
        neighbors_.values[next[b]++] = a;
    }
}

void LocalFitter::measure_edges() {
    const int count = arrays_.vertex_count();
    std::vector<double> own(count, 0);
    for (int v = 0; v < count; ++v) {
        for (const int* n = neighbors_.begin(v); n != neighbors_.end(v); ++n)
            own[v] += (arrays_.points[*n] - arrays_.points[v]).norm();
        if (neighbors_.size(v) > 0) own[v] /= neighbors_.size(v);
    }
    edge_lengths_.resize(count);
    for (int v = 0; v < count; ++v) {
        double sum = own[v];
        for (const int* n = neighbors_.begin(v); n != neighbors_.end(v); ++n) sum += own[*n];
        edge_lengths_[v] = sum / (1 + neighbors_.size(v));
    }
}

std::vector<Vec3> LocalFitter::smooth_normals(const LocalFitOptions& options) const {
    double rings = options.rings;
    if (options.radius > 0 && arrays_.mean_edge_length > 0)
        rings = options.radius / arrays_.mean_edge_length;
    const int rounds = static_cast<int>(
        std::min(kMostNormalRounds, std::round(rings * rings * kNormalRoundsPerSquare)));
    std::vector<Vec3> normals = normals_, next = normals_;
    for (int round = 0; round < rounds; ++round) {
        for (int v = 0; v < arrays_.vertex_count(); ++v) {
            if (is_on_barrier_[v]) continue;
            Vec3 sum = normals[v];
            for (const int* n = neighbors_.begin(v); n != neighbors_.end(v); ++n)
                if (!is_on_barrier_[*n]) sum += normals[*n];
            next[v] = sum.normalized();
        }
        normals.swap(next);
    }
    return normals;
}

std::vector<VertexFit> LocalFitter::fit_some(const std::vector<int>& vertices,
                                             const LocalFitOptions& options) const {
    std::vector<VertexFit> fits(vertices.size());
    const std::vector<Vec3> smooth = smooth_normals(options);
    const VertexFitter fitter(*this, arrays_, smooth, options);
    tbb::enumerable_thread_specific<Workspace> workspaces;
    // More threads than there are would make TBB print a warning.
    tbb::task_arena arena(
        std::clamp(options.threads, 1, std::max(1, tbb::this_task_arena::max_concurrency())));
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertices.size(), 256),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              Workspace& work = workspaces.local();
                              for (std::size_t i = range.begin(); i < range.end(); ++i)
                                  fits[i] = fitter.fit(vertices[i], work);
                          });
    });
    return fits;
}

std::vector<VertexFit> LocalFitter::fit_all(const LocalFitOptions& options) const {
    std::vector<int> vertices(arrays_.vertex_count());
    std::iota(vertices.begin(), vertices.end(), 0);
    return fit_some(vertices, options);
}

}  // namespace fcn

// Polygons to triangles. A quad is cut along the diagonal whose worse triangle has the larger
// quality (area over squared edge lengths, signed against the quad's mean normal, so that a concave
// quad is never folded over). A larger polygon is ear-clipped in the plane of its mean normal
// (Newell), always taking the ear of best quality, ties to the lowest corner: plain clipping in
// index order leaves slivers. If no ear is left (self-intersecting outline) the remaining corners
// are fanned.

#include <algorithm>

#include "geometry/errors.h"
#include "geometry/polygon_soup.h"

namespace fcn {

namespace {

constexpr std::size_t kMostCorners = 20000;

/// Area over the sum of squared edge lengths, negative when facing away from `normal`.
double signed_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
    const double sum = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    if (sum == 0) return 0;
    return (b - a).cross(c - a).dot(normal) / sum;
}

Vec3 newell_normal(const std::vector<Vec3>& points, const int* corners, std::size_t count) {
    Vec3 normal = Vec3::Zero();
    const Vec3& origin = points[corners[0]];
    for (std::size_t i = 1; i + 1 < count; ++i) {
        normal += (points[corners[i]] - origin).cross(points[corners[i + 1]] - origin);
    }
    const double length = normal.norm();
    return length > 0 ? Vec3(normal / length) : Vec3(Vec3::Zero());
}

class EarClipper {
public:
    EarClipper(const std::vector<Vec3>& points, const int* corners, std::size_t count)
        : points_(points),
          ring_(corners, corners + count),
          normal_(newell_normal(points, corners, count)) {}

    template <typename Emit>
    void run(Emit emit) {
        quality_.resize(ring_.size());
        for (std::size_t i = 0; i < ring_.size(); ++i) quality_[i] = ear_quality(i);
        while (ring_.size() > 3) {
            const std::size_t ear =
                std::max_element(quality_.begin(), quality_.end()) - quality_.begin();
            if (quality_[ear] <= 0) break;
            emit(corner(ear, -1), ring_[ear], corner(ear, 1));
            ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
            quality_.erase(quality_.begin() + static_cast<std::ptrdiff_t>(ear));
            const std::size_t before = (ear + ring_.size() - 1) % ring_.size();
            const std::size_t after = ear % ring_.size();
            quality_[before] = ear_quality(before);
            quality_[after] = ear_quality(after);
        }
        for (std::size_t i = 1; i + 1 < ring_.size(); ++i) emit(ring_[0], ring_[i], ring_[i + 1]);
    }

private:
    int corner(std::size_t i, int step) const {
        return ring_[(i + ring_.size() + static_cast<std::size_t>(step)) % ring_.size()];
    }

    double ear_quality(std::size_t i) const {
        const Vec3& a = points_[corner(i, -1)];
        const Vec3& b = points_[ring_[i]];
        const Vec3& c = points_[corner(i, 1)];
        const double quality = signed_quality(a, b, c, normal_);
        if (quality <= 0) return quality;
        for (int other : ring_) {
            const Vec3& p = points_[other];
            if (p == a || p == b || p == c) continue;
            if (signed_quality(a, b, p, normal_) >= 0 && signed_quality(b, c, p, normal_) >= 0 &&
                signed_quality(c, a, p, normal_) >= 0) {
                return -1;
            }
        }
        return quality;
    }

    const std::vector<Vec3>& points_;
    std::vector<int> ring_;
    std::vector<double> quality_;
    Vec3 normal_;
};

template <typename Emit>
void cut_quad(const std::vector<Vec3>& points, const int* q, Emit emit) {
    const Vec3 normal = newell_normal(points, q, 4);
    const auto quality = [&](int a, int b, int c) {
        return signed_quality(points[q[a]], points[q[b]], points[q[c]], normal);
    };
    const double along_02 = std::min(quality(0, 1, 2), quality(0, 2, 3));
    const double along_13 = std::min(quality(1, 2, 3), quality(1, 3, 0));
    // Nearly equal counts as equal: the choice must not hang on rounding.
    if (along_13 > along_02 + 1e-9) {
        emit(q[0], q[1], q[3]);
        emit(q[1], q[2], q[3]);
    } else {
        emit(q[0], q[1], q[2]);
        emit(q[0], q[2], q[3]);
    }
}

}  // namespace

TriangleSoup triangulate(PolygonSoup&& soup, const std::string& source, RepairReport& report) {
    TriangleSoup result;
    result.triangles.reserve(soup.corners.size() -
                             2 * std::min(soup.corners.size() / 2, soup.polygon_count()));
    if (!soup.labels.empty()) result.labels.reserve(result.triangles.capacity());
    for (std::size_t polygon = 0; polygon < soup.polygon_count(); ++polygon) {
        const int* corners = soup.corners.data() + soup.corner_begin[polygon];
        const std::size_t count = soup.corner_begin[polygon + 1] - soup.corner_begin[polygon];
        const auto emit = [&](int a, int b, int c) {
            result.triangles.push_back({a, b, c});
            if (!soup.labels.empty()) result.labels.push_back(soup.labels[polygon]);
        };
        if (count < 3) {
            ++report.degenerate_face_count;
        } else if (count == 3) {
            emit(corners[0], corners[1], corners[2]);
        } else {
            ++report.triangulated_polygon_count;
            if (count > kMostCorners) {
                throw InputError(source + ": face " + std::to_string(polygon) + " has " +
                                 std::to_string(count) + " corners, at most " +
                                 std::to_string(kMostCorners) + " are supported");
            }
            if (count == 4) {
                cut_quad(soup.points, corners, emit);
            } else {
                EarClipper(soup.points, corners, count).run(emit);
            }
        }
    }
    result.points = std::move(soup.points);
    return result;
}

}  // namespace fcn

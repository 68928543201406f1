// A software renderer for still pictures: z-buffer, soft lighting, polylines with hidden parts
// removed, 2x2 supersampling. No graphics driver is needed and the same input gives the same bytes
// everywhere. A polyline is walked in steps of half a pixel; a point is visible if the z-buffer
// around it lies at most a small bias in front of it, and a visible point stamps a round brush, so
// joins and ends are round. Testing the centre line, not each pixel of the stroke, keeps strokes
// along silhouettes whole.
#include "report/picture.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/errors.h"
#include "report/camera.h"
#include "report/png_writer.h"
#include "report/raster.h"

namespace fcn {
namespace {

using Rgb = Eigen::Vector3f;

constexpr int kSupersampling = 2;
constexpr int kMaxPixels = 16384;  ///< per side
/// A curve may lie this share of the picture's diagonal behind the surface and still be seen.
constexpr double kDepthBias = 0.002;

Rgb to_rgb(const Color& color) { return Rgb(color.r, color.g, color.b); }

/// Light from the upper left, a weaker one from the right, brighter sky than ground, and a darker
/// rim so that the shape stands off the background; shadows lean to blue. Factors on the colour.
Rgb lighting(const Eigen::Vector3f& normal, float open) {
    static const Eigen::Vector3f key = Eigen::Vector3f(-0.40F, 0.60F, 0.70F).normalized();
    static const Eigen::Vector3f fill = Eigen::Vector3f(0.80F, 0.05F, 0.50F).normalized();
    const float ambient = 0.50F + 0.13F * normal[1];
    const float diffuse =
        0.45F * std::max(0.0F, normal.dot(key)) + 0.20F * std::max(0.0F, normal.dot(fill));
    const float grazing = 1 - std::clamp(normal[2], 0.0F, 1.0F);
    const float rim = 1 - 0.28F * grazing * grazing * grazing;
    const float shadow = 1 - 0.75F * (1 - open);
    const float light = std::clamp((ambient + diffuse) * rim * shadow, 0.0F, 1.06F);
    return {std::pow(light, 1.06F), std::pow(light, 1.01F), std::pow(light, 0.95F)};
}

Rgb background(double height_share) {
    const auto t = static_cast<float>(height_share);
    return (1 - t) * Rgb(253, 253, 254) + t * Rgb(238, 241, 245);
}

std::vector<Rgb> shade(const Raster& raster, const PictureOptions& options,
                       double pixels_per_unit) {
    const std::vector<float> open = ambient_occlusion(raster, pixels_per_unit);
    const Rgb surface = to_rgb(options.surface);
    const Rgb inside(226, 205, 186);  // the back of open meshes
    const Rgb wire(52, 64, 84);
    std::vector<Rgb> image(raster.depth.size());
    tbb::parallel_for(0, raster.height, [&](int y) {
        for (int x = 0; x < raster.width; ++x) {
            const std::size_t i = raster.index(x, y);
            if (!std::isfinite(raster.depth[i])) {
                image[i] = background(static_cast<double>(y) / raster.height);
                continue;
            }
            Rgb color = (raster.is_back[i] ? inside : surface)
                            .cwiseProduct(lighting(raster.normal[i], open[i]));
            if (options.is_drawing_wireframe) {
                // Half of the line on each side of an edge; fades where faces are a few pixels.
                const float half_width = 0.6F * kSupersampling;
                const float ink = std::clamp(half_width + 0.5F - raster.edge_distance[i], 0.F, 1.F);
                const float room = std::clamp(raster.edge_length[i] / (8 * half_width), 0.15F, 1.F);
                color += 0.62F * ink * room * (wire - color);
            }
            image[i] = color.cwiseMin(255.0F);
        }
    });
    return image;
}

/// Whether a point of a curve (pixels, depth) is in front of the surface around its pixel.
bool is_visible(const Raster& raster, const Vec3& point, double bias) {
    const int x = static_cast<int>(std::floor(point[0]));
    const int y = static_cast<int>(std::floor(point[1]));
    float farthest = std::numeric_limits<float>::infinity();
    for (int v = y - 1; v <= y + 1; ++v) {
        for (int u = x - 1; u <= x + 1; ++u) {
            const bool is_outside = u < 0 || v < 0 || u >= raster.width || v >= raster.height;
            farthest = is_outside ? -std::numeric_limits<float>::infinity()
                                  : std::min(farthest, raster.depth[raster.index(u, v)]);
            if (is_outside) return true;
        }
    }
    return farthest <= point[2] + bias;
}

/// Coverage of one layer's strokes per pixel, [0, 1].
class Stroke {
public:
    Stroke(const Raster& raster, double width, double bias)
        : raster_(raster), coverage_(raster.depth.size(), 0), radius_(width / 2), bias_(bias) {}

    void draw(const std::vector<Vec3>& points) {
        if (points.size() == 1) dot(points.front());
        for (std::size_t i = 1; i < points.size(); ++i) line(points[i - 1], points[i]);
    }
    float coverage(std::size_t pixel) const { return coverage_[pixel]; }

private:
    void line(const Vec3& from, const Vec3& to) {
        const double length = (to - from).head<2>().norm();
        const int steps = std::max(1, static_cast<int>(std::ceil(length * 2)));
        for (int i = 0; i <= steps; ++i) {
            const double t = static_cast<double>(i) / steps;
            stamp((1 - t) * from + t * to, radius_);
        }
    }

    /// A polyline of one point: a dot somewhat wider than the line.
    void dot(const Vec3& point) { stamp(point, radius_ * 1.6); }

    void stamp(const Vec3& point, double radius) {
        const double reach = radius + 1;
        const bool is_off_picture = !(point[0] > -reach && point[0] < raster_.width + reach &&
                                      point[1] > -reach && point[1] < raster_.height + reach);
        if (is_off_picture || !is_visible(raster_, point, bias_)) return;
        const int x0 = std::max(0, static_cast<int>(std::floor(point[0] - reach)));
        const int x1 = std::min(raster_.width - 1, static_cast<int>(std::ceil(point[0] + reach)));
        const int y0 = std::max(0, static_cast<int>(std::floor(point[1] - reach)));
        const int y1 = std::min(raster_.height - 1, static_cast<int>(std::ceil(point[1] + reach)));
        for (int y = y0; y <= y1; ++y) {
            for (int x = x0; x <= x1; ++x) {
                const double distance = std::hypot(x + 0.5 - point[0], y + 0.5 - point[1]);
                const auto ink = static_cast<float>(std::clamp(radius + 0.5 - distance, 0.0, 1.0));
                float& coverage = coverage_[raster_.index(x, y)];
                coverage = std::max(coverage, ink);
            }
        }
    }

    const Raster& raster_;
    std::vector<float> coverage_;
    double radius_;
    double bias_;
};

void draw_layer(std::vector<Rgb>& image, const Raster& raster, const PictureLayer& layer,
                const Projection& projection, double bias) {
    Stroke stroke(raster, layer.width * kSupersampling, bias);
    for (const auto& polyline : layer.polylines) {
        std::vector<Vec3> points;
        points.reserve(polyline.size());
        for (const Vec3& point : polyline)
            if (point.allFinite()) points.push_back(projection(point));
        stroke.draw(points);
    }
    const Rgb color = to_rgb(layer.color);
    for (std::size_t i = 0; i < image.size(); ++i) {
        const float ink = stroke.coverage(i);
        if (ink > 0) image[i] += ink * (color - image[i]);
    }
}

std::vector<std::uint8_t> downsample(const std::vector<Rgb>& image, int width, int height) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const std::size_t stride = static_cast<std::size_t>(width) * kSupersampling;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            Rgb sum = Rgb::Zero();
            for (int v = 0; v < kSupersampling; ++v)
                for (int u = 0; u < kSupersampling; ++u)
                    sum += image[static_cast<std::size_t>(y * kSupersampling + v) * stride +
                                 static_cast<std::size_t>(x * kSupersampling + u)];
            sum /= kSupersampling * kSupersampling;
            for (int channel = 0; channel < 3; ++channel)
                bytes.push_back(
                    static_cast<std::uint8_t>(std::lround(std::clamp(sum[channel], 0.0F, 255.0F))));
        }
    }
    return bytes;
}

void check_options(const PictureOptions& options) {
    const bool is_size_valid = options.width > 0 && options.height > 0 &&
                               options.width <= kMaxPixels && options.height <= kMaxPixels;
    if (!is_size_valid)
        throw InputError("picture: size " + std::to_string(options.width) + " x " +
                         std::to_string(options.height) + " is not within 1 .. " +
                         std::to_string(kMaxPixels) + " pixels");
}

}  // namespace

std::string render_png(const Mesh& mesh, const std::vector<PictureLayer>& layers,
                       const PictureOptions& options) {
    check_options(options);
    const Mesh& framed = options.seen_as ? *options.seen_as : mesh;
    const CameraFrame camera =
        options.view.isZero(0) ? choose_camera(framed) : make_camera(options.view, options.up);
    const int width = options.width * kSupersampling, height = options.height * kSupersampling;
    const Projection projection(camera, framed, width, height);
    const Raster raster = rasterize(mesh, projection, width, height, options.is_drawing_wireframe);
    std::vector<Rgb> image = shade(raster, options, projection.pixels_per_unit());
    const double bias = mesh.n_vertices() == 0 ? 0 : kDepthBias * bounding_box(mesh).diagonal();
    for (const PictureLayer& layer : layers) draw_layer(image, raster, layer, projection, bias);
    return encode_png(downsample(image, options.width, options.height), options.width,
                      options.height);
}

}  // namespace fcn

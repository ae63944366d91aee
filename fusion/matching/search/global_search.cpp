// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/global_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "fusion/matching/search/fourier.hpp"

namespace cairn::matching {
namespace {

// A wider one asks for a larger image, while there is one. By hand, not tuned.
constexpr float kWidestPixel_m = 0.5F;
// Edges; powers of two, for fourier().
constexpr int kSmallestImage_px = 64, kLargestImage_px = 256;
// Of an image, for dab() and the drawing's offset.
constexpr int kRim_px = 4;
// Weight of the directions that walls face, against that of the walls alone. From a prototype,
// which had both at 1.
constexpr float kFacingWeight = 1;
constexpr std::size_t kCircle_deg = 360;

/// How well the directions of walls agree under each heading.
std::vector<double> agreement(const PlanView& a, const PlanView& b, std::size_t headings) {
  const auto n = a.directions().size();
  std::vector<double> all(headings, 0.0);
  for (std::size_t k = 0; k < all.size(); ++k)
    for (std::size_t i = 0; i < n; ++i)
      all[k] += static_cast<double>(a.directions()[(i + k * kCircle_deg / headings) % n] * b.directions()[i]);
  return all;
}

/// The image on which a plan is drawn: a in its own place, or b turned about its middle.
struct Canvas {
  float pixel_m;
  int edge;
};

Canvas canvas_of(const PlanView& a, const PlanView& b, float pixel_m) {
  const float extent = (a.high() - a.low()).maxCoeff() + 2 * b.radius();
  Canvas c{pixel_m, kSmallestImage_px};
  while (c.edge < kLargestImage_px && extent > kWidestPixel_m * static_cast<float>(c.edge - kRim_px)) c.edge *= 2;
  c.pixel_m = std::max(c.pixel_m, extent / static_cast<float>(c.edge - kRim_px));
  return c;
}

/// Adds `value` to the four pixels around `at`, by how near they are.
void dab(ComplexImage::Plane& plane, const Eigen::Vector2f& at, float value) {
  const int x = static_cast<int>(at.x()), y = static_cast<int>(at.y());
  const float u = at.x() - static_cast<float>(x), v = at.y() - static_cast<float>(y);
  if (x < 0 || y < 0 || x + 1 >= plane.cols() || y + 1 >= plane.rows()) return;
  plane(y, x) += value * (1 - u) * (1 - v);
  plane(y, x + 1) += value * u * (1 - v);
  plane(y + 1, x) += value * (1 - u) * v;
  plane(y + 1, x + 1) += value * u * v;
}

/// The spectrum of the same image mirrored in space and conjugated: what a real image does not
/// change.
ComplexImage mirrored(const ComplexImage& s) {
  const int n = s.edge();
  ComplexImage out(n);
  const auto turn = [n](const ComplexImage::Plane& from, ComplexImage::Plane& to, float sign) {
    to(0, 0) = sign * from(0, 0);
    to.row(0).tail(n - 1) = sign * from.row(0).tail(n - 1).reverse();
    to.col(0).tail(n - 1) = sign * from.col(0).tail(n - 1).reverse();
    to.bottomRightCorner(n - 1, n - 1) = sign * from.bottomRightCorner(n - 1, n - 1).reverse();
  };
  turn(s.re, out.re, 1);
  turn(s.im, out.im, -1);
  return out;
}

/// Spectra of what a plan shows.
struct Drawing {
  explicit Drawing(int edge) : walls(edge), room(edge), facing(edge) {}
  ComplexImage walls, room;
  ComplexImage facing;  // of x + i y
};

/// Parts the spectrum of two real images that shared one transform, as real and imaginary part.
void part(ComplexImage& both, ComplexImage& second) {
  const ComplexImage m = mirrored(both);
  second.re = 0.5F * (both.im - m.im);
  second.im = 0.5F * (m.re - both.re);
  both.re = 0.5F * (both.re + m.re);
  both.im = 0.5F * (both.im + m.im);
}

/// `corner`: what is drawn at pixel 1, after turning about `pivot`.
Drawing draw(const PlanView& plan, const Canvas& canvas, const Eigen::Rotation2Df& turn, const Eigen::Vector2f& pivot,
             const Eigen::Vector2f& corner) {
  Drawing d(canvas.edge);
  for (const PlanView::Column& c : plan.columns()) {
    const Eigen::Vector2f at = (turn * (c.at - pivot) - corner) / canvas.pixel_m + Eigen::Vector2f::Ones();
    if (!(at.minCoeff() >= 0)) continue;
    if (c.open > 0) dab(d.walls.im, at, c.open);
    if (c.mass == 0) continue;
    dab(d.walls.re, at, c.mass);
    const Eigen::Vector2f facing = turn * c.facing;
    dab(d.facing.re, at, facing.x());
    dab(d.facing.im, at, facing.y());
  }
  fourier(d.walls);
  fourier(d.facing);
  part(d.walls, d.room);
  return d;
}

/// sum += a·conj(b)
void add_product(const ComplexImage& a, const ComplexImage& b, ComplexImage& sum) {
  sum.re += a.re * b.re + a.im * b.im;
  sum.im += a.im * b.re - a.re * b.im;
}

/// Spectrum whose real part, in space, is how well walls and the ways they face agree for each
/// shift of b, and whose imaginary part is how much of either map's walls then stands in the
/// other's room.
ComplexImage correlation(const Drawing& a, const Drawing& b) {
  const int n = a.walls.edge();
  ComplexImage agree(n), clash(n), faces(n);
  add_product(a.facing, b.facing, faces);
  const ComplexImage m = mirrored(faces);  // the real part of a complex correlation is what counts
  agree.re = 0.5F * kFacingWeight * (faces.re + m.re);
  agree.im = 0.5F * kFacingWeight * (faces.im + m.im);
  add_product(a.walls, b.walls, agree);
  add_product(a.walls, b.room, clash);
  add_product(a.room, b.walls, clash);
  agree.re -= clash.im;
  agree.im += clash.re;
  return agree;
}

/// The same of the plan turned by half a circle about the first pixel: its image backwards.
Drawing half_turned(const Drawing& d) {
  Drawing out = d;
  out.walls.im = -d.walls.im;
  out.room.im = -d.room.im;
  const ComplexImage m = mirrored(d.facing);
  out.facing.re = -m.re;  // what faced ahead faces back
  out.facing.im = m.im;
  return out;
}

struct Peak {
  float score;
  int x, y;
};

/// The highest local maxima of an image that continues at its opposite edges.
std::vector<Peak> peaks_of(const ComplexImage::Plane& image, std::size_t most) {
  const int n = static_cast<int>(image.rows());
  std::vector<Peak> best;
  const auto higher = [](const Peak& p, const Peak& q) { return p.score > q.score; };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const float score = image(y, x);
      if (score <= 0 || (best.size() == most && score <= best.back().score)) continue;
      bool top = true;
      for (int k = 0; k < 9 && top; ++k) top = image((y + k / 3 - 1 + n) % n, (x + k % 3 - 1 + n) % n) <= score;
      if (!top) continue;
      const Peak p{.score = score, .x = x, .y = y};
      best.insert(std::upper_bound(best.begin(), best.end(), p, higher), p);
      if (best.size() > most) best.pop_back();
    }
  return best;
}

/// The sweep over headings of one pair of plans. Each heading of b is drawn together with the opposite one.
class Sweep {
 public:
  Sweep(const PlanView& a, const PlanView& b, const GlobalSearchConfig& config)
      : a_(a),
        b_(b),
        config_(config),
        canvas_(canvas_of(a, b, config.pixel_m)),
        reach_px_(static_cast<int>(std::ceil(b.radius() / canvas_.pixel_m))),
        of_a_(draw(a, canvas_, Eigen::Rotation2Df(0), Eigen::Vector2f::Zero(), a.low())) {}

  /// Tries heading k and the opposite one.
  void look(int k, Budget& budget) {
    if (!budget.one_more()) return;
    const double yaw = 2 * M_PI * k / config_.headings;
    const Eigen::Vector2f corner = Eigen::Vector2f::Constant(-canvas_.pixel_m * static_cast<float>(reach_px_));
    const Drawing ahead = draw(b_, canvas_, Eigen::Rotation2Df(static_cast<float>(yaw)), b_.middle(), corner);
    note(ahead, yaw, 0);
    // b's middle is at pixel 1 + reach, and so as far before the first pixel.
    if (budget.one_more()) note(half_turned(ahead), yaw + M_PI, 2 * (1 + reach_px_));
  }

  /// Best first, in turn by each weight of free space.
  [[nodiscard]] std::vector<Placement> placements() {
    for (auto& of_weight : found_)
      of_weight = different_places(std::move(of_weight), config_.placements / found_.size());
    std::vector<Placement> all;
    for (std::size_t i = 0; i < config_.placements; ++i)
      for (const auto& of_weight : found_)
        if (i < of_weight.size()) all.push_back(of_weight[i]);
    return all;
  }

 private:
  /// The peaks of one heading, whose drawing lies `behind_px` before its place.
  void note(const Drawing& of_b, double yaw, int behind_px) {
    ComplexImage c = correlation(of_a_, of_b);
    inverse_fourier(c);
    for (std::size_t w = 0; w < found_.size(); ++w)
      for (const Peak& p : peaks_of(c.re - config_.room_weights[w] * c.im, config_.peaks_per_heading))
        found_[w].push_back({.yaw_rad = yaw,
                             .x_m = metres(p.x - behind_px, a_.low().x()),
                             .y_m = metres(p.y - behind_px, a_.low().y()),
                             .score = p.score});
  }

  /// Where a shift of b takes its middle, along one axis.
  [[nodiscard]] double metres(int shift, float low) const {
    const int furthest = static_cast<int>((a_.high() - a_.low()).maxCoeff() / canvas_.pixel_m) + 2;
    const int wrapped = (shift % canvas_.edge + canvas_.edge) % canvas_.edge;
    const int to = wrapped > furthest ? wrapped - canvas_.edge : wrapped;
    return static_cast<double>(low + canvas_.pixel_m * static_cast<float>(reach_px_ + to));
  }

  const PlanView &a_, &b_;
  const GlobalSearchConfig& config_;
  Canvas canvas_;
  int reach_px_;  // from b's middle to its farthest wall
  Drawing of_a_;
  std::array<std::vector<Placement>, std::tuple_size_v<decltype(GlobalSearchConfig::room_weights)>> found_;
};

}  // namespace

std::vector<Placement> sweep(const PlanView& a, const PlanView& b, const GlobalSearchConfig& config, Budget& budget) {
  const std::vector<double> alike = agreement(a, b, static_cast<std::size_t>(config.headings));
  const double least = config.least_agreement * *std::max_element(alike.begin(), alike.end());
  Sweep all(a, b, config);
  // Directions of walls are the same for opposite headings.
  for (int k = 0; k < config.headings / 2; ++k)
    if (alike[static_cast<std::size_t>(k)] >= least) all.look(k, budget);
  return all.placements();
}

}  // namespace cairn::matching

// Compares fine lines of a skin's film with the theory of a film on a half-space (Cao & Hutchinson 2012), and checks
// how frames get the lines.

#include "film_model.hpp"
#include "frontalis/solver/fine_lines.hpp"
#include "frontalis/solver/surface_normals.hpp"
#include "solver/skin/film_equilibrium.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace frontalis
{
namespace
{

using test::film_model;
using Vertices = std::vector<std::array<float, 3>>;

constexpr double pi = 3.14159265358979323846;
constexpr double thickness = test::film_thickness;

double width(const Model& model) { return model.skin.vertices.back()[0]; }

// The skin, compressed along the direction at `angle` to x. `where`: integral of the local shortening from 0 to a
// position along this direction, relative to the shortening at `strain`; null: the strain is uniform.
Vertices compressed(const Model& model, double strain, double angle = 0,
                    double (*where)(double along, double width) = nullptr)
{
  const double c = std::cos(angle), s = std::sin(angle), w = width(model);
  Vertices vertices;
  vertices.reserve(model.skin.vertices.size());
  for (const auto& p : model.skin.vertices)
  {
    const double along = c * p[0] + s * p[1];
    // The displacement follows from the Green-Lagrange strain (stretch^2 - 1) / 2.
    const double moved = (std::sqrt(1 - 2 * strain) - 1) * (where == nullptr ? along : where(along, w));
    vertices.push_back({ { static_cast<float>(p[0] + c * moved), static_cast<float>(p[1] + s * moved), 0 } });
  }
  return vertices;
}

// The heights after some frames of the same skin.
std::vector<float> heights(FilmEquilibrium& film, const Vertices& vertices, int frames = 6,
                           std::vector<float> from = {})
{
  for (int i = 0; i < frames; ++i)
    film.solve(vertices, from);
  return from;
}

bool in_the_middle(const Model& model, std::size_t v)
{
  const auto& p = model.skin.vertices[v];
  const double w = width(model);
  return std::min({ p[0], p[1], w - p[0], w - p[1] }) > 0.2 * w;
}

double amplitude(const Model& model, const std::vector<float>& height)
{
  double sum = 0, count = 0;
  for (std::size_t v = 0; v < height.size(); ++v)
    if (in_the_middle(model, v))
    {
      sum += static_cast<double>(height[v]) * height[v];
      ++count;
    }
  return std::sqrt(2 * sum / count);
}

// Mean wavelength: twice the length of all edges across the lines, divided by the number of edges with different signs
// of the height at their ends.
double wavelength(const Model& model, const std::vector<float>& height, double angle)
{
  double length = 0, changes = 0;
  for (const auto& t : model.skin.triangles)
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t a = t[c], b = t[(c + 1) % 3];
      if (!in_the_middle(model, a) || !in_the_middle(model, b))
        continue;
      const auto &p = model.skin.vertices[a], &q = model.skin.vertices[b];
      length += std::abs((q[0] - p[0]) * std::cos(angle) + (q[1] - p[1]) * std::sin(angle));
      changes += (height[a] > 0) != (height[b] > 0) ? 1 : 0;
    }
  return 2 * length / changes;
}

TEST(Film, FoldsAtTheWavelengthAndTheAmplitudeOfTheory)
{
  std::printf(
      "found over theory\nstiffness ratio, direction [degrees], wavelength at 1.1, 1.4, 2.6 times the critical "
      "strain, amplitude, exponent of the excess, critical strain\n");
  for (const double ratio : { 30.0, 100.0, 1000.0 })
    for (const double angle : { 0.0, pi / 6 })
    {
      const Model model = film_model(ratio);
      FilmEquilibrium film(model, 0);
      constexpr double excess[] = { 0.1, 0.4, 1.6 };
      double found[3], length[3];
      std::vector<float> height;
      for (int i = 0; i < 3; ++i)
      {
        height = heights(film, compressed(model, (1 + excess[i]) * film_critical_strain(model.film.laws[0]), angle), 6,
                         height);
        length[i] = wavelength(model, height, angle) / film_wavelength(model.film.laws[0]);
        found[i] = amplitude(model, height) / thickness;
        EXPECT_NEAR(length[i], 1, 0.1) << ratio << " " << angle << " " << excess[i];
        EXPECT_NEAR(found[i] / std::sqrt(excess[i]), 1, 0.15) << ratio << " " << angle << " " << excess[i];
      }
      const double exponent = std::log(found[2] / found[1]) / std::log(4.0);
      EXPECT_NEAR(exponent, 0.5, 0.05);
      // The critical strain is where the line through the squares of the first two amplitudes is 0.
      const double first = found[0] * found[0], second = found[1] * found[1];
      const double critical = (1.1 * second - 1.4 * first) / (second - first);
      EXPECT_NEAR(critical, 1, 0.15);
      std::printf("%4.0f %2.0f  %.3f %.3f %.3f  %.3f %.3f %.3f  %.3f  %.3f\n", ratio, 180 / pi * angle, length[0],
                  length[1], length[2], found[0] / std::sqrt(0.1), found[1] / std::sqrt(0.4), found[2] / std::sqrt(1.6),
                  exponent, critical);
    }
}

// In a grid of squares whose diagonals alternate, every other vertex is a corner of eight triangles, and the others of
// four.
TEST(Film, HeightsDoNotFollowTheDiagonals)
{
  Model model = film_model(100);
  constexpr std::size_t n = 61;
  const double edge = width(model) / (n - 1);
  for (std::size_t v = 0; v < n * n; ++v)
    model.skin.vertices[v] = { { edge * static_cast<double>(v % n), edge * static_cast<double>(v / n), 0 } };
  FilmEquilibrium film(model, 0);
  const auto height = heights(film, compressed(model, 2 * film_critical_strain(model.film.laws[0])));
  double squares[2] = { 0, 0 };
  for (std::size_t v = 0; v < n * n; ++v)
    if (in_the_middle(model, v))
      squares[(v % n + v / n) % 2] += static_cast<double>(height[v]) * height[v];
  EXPECT_GT(squares[0], 0);
  EXPECT_NEAR(std::sqrt(squares[1] / squares[0]), 1, 0.02);
}

TEST(Film, FoldsFromTheCriticalStrainOfTheoryOnAndIsFlatBelowIt)
{
  const Model model = film_model(100);
  FilmEquilibrium film(model, 0);
  const double critical = film_critical_strain(model.film.laws[0]);
  EXPECT_EQ(amplitude(model, heights(film, compressed(model, 0.85 * critical), 1)), 0);
  EXPECT_GT(amplitude(model, heights(film, compressed(model, 1.15 * critical), 20)), 0.2 * thickness);
  // Lines that are already deep become flat again.
  const std::vector<float> deep = heights(film, compressed(model, 3 * critical));
  EXPECT_LT(amplitude(model, heights(film, compressed(model, 0.85 * critical), 20, deep)), 1e-3 * thickness);
  const std::vector<float> flat = heights(film, compressed(model, 0), 1, deep);
  EXPECT_EQ(flat, std::vector<float>(flat.size(), 0.0F));
}

TEST(Film, AStretchOfTheFilmAtRestDelaysLines)
{
  Model model = film_model(100);
  model.film.laws[0].stretch = 0.1;
  // The film is also stretched along the lines, which delays them by Poisson's ratio times that stretch.
  const double needed =
      film_critical_strain(model.film.laws[0]) + (1 + model.film.laws[0].poisson) * model.film.laws[0].stretch;
  FilmEquilibrium film(model, 0);
  EXPECT_EQ(amplitude(model, heights(film, compressed(model, 0.9 * needed), 1)), 0);
  EXPECT_GT(amplitude(model, heights(film, compressed(model, 1.1 * needed))), 0.2 * thickness);
}

// At the wavelength of lines the base is twice as stiff as the film's bending, so that a third of a crease stays.
TEST(Film, AThirdOfACreaseShowsAtRest)
{
  Model model = film_model(100);
  const double k = 2 * pi / film_wavelength(model.film.laws[0]), deep = thickness;
  for (const auto& v : model.skin.vertices)
    model.film.crease.push_back(static_cast<float>(deep * std::cos(k * v[0])));
  const Vertices rest = compressed(model, 0);
  FilmEquilibrium creased(model, 0);
  const std::vector<float> height = heights(creased, rest);
  // with six edges per wave, the discrete curvature of a wave is a tenth smaller than the true one
  EXPECT_NEAR(amplitude(model, height), deep / 3, 0.05 * deep);
  EXPECT_NEAR(wavelength(model, height, 0), film_wavelength(model.film.laws[0]),
              0.05 * film_wavelength(model.film.laws[0]));
  // Tension draws creases flat. Compression by the critical strain would be a force of - 3 in these units.
  model.film.laws[0].stretch = 0.5 * film_critical_strain(model.film.laws[0]);
  FilmEquilibrium stretched(model, 0);
  EXPECT_NEAR(amplitude(model, heights(stretched, rest)), deep / (3 + 1.5 * (1 + model.film.laws[0].poisson)),
              0.02 * deep);
}

// Heights are 0 at the border of a region, where the skin's mesh ends or a film of another kind begins.
TEST(Film, CreasesMakeNoLineAlongTheBorder)
{
  Model model = film_model(100);
  const double k = 2 * pi / film_wavelength(model.film.laws[0]), deep = thickness, w = width(model);
  const auto from_border = [&](const auto& v) { return std::min({ v[0], v[1], w - v[0], w - v[1] }); };
  for (const auto& v : model.skin.vertices)
    model.film.crease.push_back(static_cast<float>(deep * std::sin(k * from_border(v))));
  FilmEquilibrium creased(model, 0);
  const std::vector<float> height = heights(creased, compressed(model, 0));
  double most = 0;
  for (std::size_t v = 0; v < height.size(); ++v)
    if (k * from_border(model.skin.vertices[v]) < 0.6 * pi)
      most = std::max(most, static_cast<double>(std::abs(height[v])));
  EXPECT_LT(most, 0.5 * deep);
}

TEST(Film, LinesAreWhereTheSkinIsCompressed)
{
  const Model model = film_model(100);
  FilmEquilibrium film(model, 0);
  const auto left = [](double along, double w) { return std::min(along, 0.5 * w); };
  const std::vector<float> height =
      heights(film, compressed(model, 3 * film_critical_strain(model.film.laws[0]), 0, left));
  double highest_left = 0, highest_right = 0;
  for (std::size_t v = 0; v < height.size(); ++v)
  {
    const double x = model.skin.vertices[v][0] / width(model), h = std::abs(static_cast<double>(height[v]));
    (x < 0.5 ? highest_left : highest_right) =
        std::max(x < 0.5 ? highest_left : highest_right, x > 0.5 && x < 0.6 ? 0 : h);
  }
  EXPECT_GT(highest_left, thickness);
  EXPECT_EQ(highest_right, 0);
}

// The right half of the skin has a thicker film. A stretch keeps the film of one half
// flat without an effect on the other.
TEST(Film, EachRegionHasLinesOfItsOwn)
{
  Model model = film_model(1000);
  FilmLaw thick = model.film.laws[0];
  thick.thickness *= 1.5;
  model.film.laws.push_back(thick);
  for (std::size_t v = 0; v < model.film.law.size(); ++v)
    model.film.law[v] = model.skin.vertices[v][0] < 0.5 * width(model) ? 0 : 1;
  const Vertices vertices = compressed(model, 2.5 * film_critical_strain(thick), pi / 2);
  const auto half_height = [&](const std::vector<float>& height, bool right)
  {
    std::vector<float> half = height;
    for (std::size_t v = 0; v < half.size(); ++v)
      if ((model.skin.vertices[v][0] < 0.5 * width(model)) == right)
        half[v] = 0;
    return half;
  };
  const auto lines = [&]
  {
    SkinState skin;
    const auto fine_lines = FineLines::make(std::make_shared<Model>(model), false);
    for (int frame = 0; frame < 6; ++frame)
    {
      skin.vertices = vertices;
      surface_normals(model.skin.triangles, skin.vertices, skin.normals);
      fine_lines->add_to(skin, true);
    }
    return skin.line_height;
  };
  const std::vector<float> height = lines();
  const double left = amplitude(model, half_height(height, false)), right = amplitude(model, half_height(height, true));
  EXPECT_GT(left, 0.5 * thickness);
  EXPECT_NEAR(right / left, 1.5, 0.15);
  model.film.laws[1].stretch = 0.5;
  const std::vector<float> stretched = lines();
  EXPECT_EQ(half_height(stretched, false), half_height(height, false));
  EXPECT_EQ(amplitude(model, half_height(stretched, true)), 0);
}

TEST(Film, IsInEquilibriumWithinTwoFrames)
{
  for (const double shear : { 0.0, 0.6 })
  {
    const Model model = film_model(100, shear);
    FilmEquilibrium film(model, 0);
    const Vertices skin = compressed(model, 1.6 * film_critical_strain(model.film.laws[0]));
    const auto size = [](const std::vector<float>& height)
    {
      double sum = 0;
      for (const float h : height)
        sum += static_cast<double>(h) * h;
      return std::sqrt(sum / static_cast<double>(height.size()));
    };
    const std::vector<float> soon = heights(film, skin, 2);
    EXPECT_NEAR(size(soon) / size(heights(film, skin, 30, soon)), 1, 0.05) << "sheared by " << shear;
  }
}

TEST(Film, IsTheSameInEveryRun)
{
  const Model model = film_model(100);
  FilmEquilibrium one(model, 0), other(model, 0);
  const Vertices vertices = compressed(model, 2 * film_critical_strain(model.film.laws[0]), 1);
  EXPECT_EQ(heights(one, vertices, 2), heights(other, vertices, 2));
}

TEST(Film, RecoversFromHeightsThatAreNoNumbers)
{
  const Model model = film_model(100);
  FilmEquilibrium film(model, 0);
  const Vertices vertices = compressed(model, 2 * film_critical_strain(model.film.laws[0]));
  for (const float bad : { std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity() })
    EXPECT_NEAR(amplitude(model, heights(film, vertices, 6, std::vector<float>(vertices.size(), bad))),
                amplitude(model, heights(film, vertices)), 1e-3 * thickness);
}

TEST(FineLines, MoveVerticesAlongTheNormalsAndTiltThese)
{
  const auto model = std::make_shared<Model>(film_model(100));
  const Vertices vertices = compressed(*model, 2 * film_critical_strain(model->film.laws[0]));
  const auto frame = [&](FineLines& lines, bool wait)
  {
    SkinState skin;
    skin.vertices = vertices;
    surface_normals(model->skin.triangles, skin.vertices, skin.normals);
    lines.add_to(skin, wait);
    return skin;
  };
  const auto lines = FineLines::make(model, false);
  const SkinState skin = frame(*lines, true);
  double steepest = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    EXPECT_EQ(skin.vertices[v][2], skin.line_height[v]);
    EXPECT_EQ(skin.vertices[v][0], vertices[v][0]);
    steepest = std::max(steepest, static_cast<double>(std::abs(skin.normals[v][0])));
  }
  EXPECT_GT(steepest, 0.1);
  EXPECT_GT(lines->seconds(), 0);

  // With a separate thread, a frame has the lines immediately only if it waits for them, also after a reset.
  const auto apart = FineLines::make(model, true);
  for (int times = 0; times < 2; ++times)
  {
    EXPECT_EQ(amplitude(*model, frame(*apart, false).line_height), 0);
    EXPECT_GT(amplitude(*model, frame(*apart, true).line_height), 0.2 * thickness);
    apart->reset();
  }
  EXPECT_EQ(frame(*apart, true).line_height, skin.line_height);

  model->film = SkinFilm();
  EXPECT_EQ(FineLines::make(model, false), nullptr);
}

}  // namespace
}  // namespace frontalis

#include "bake/messages.hpp"
#include "bake/shapes/head/head.hpp"

#include <Eigen/Dense>

namespace frontalis
{
namespace
{

// Correlation length of the landmarks' displacements: about half the height of a face.
constexpr double correlation_length = 60e-3;  // [m]
constexpr int iterations = 12;
// The head is shifted so that this landmark, the fissure of the mouth, keeps its height: the lips keep their voxels.
constexpr const char* level_landmark = "sto";
// A dimension that differs from the mean by more than this number of standard deviations is refused: hardly one person
// in 10^8 has it.
constexpr double most_deviations = 6;
// A dimension that other dimensions determine may be given if it differs from the resulting value by at most this.
constexpr double derived_tolerance = 1e-3;  // [m]

double covariance(double distance)
{
  const double r = std::sqrt(3.0) * distance / correlation_length;
  return (1 + r) * std::exp(-r);
}

Vector3d covariance_gradient(const Vector3d& way)
{
  const double r = std::sqrt(3.0) * way.norm() / correlation_length;
  return -3 / (correlation_length * correlation_length) * std::exp(-r) * way;
}

Vector3d mirrored(Vector3d p)
{
  p[1] = -p[1];
  return p;
}

/// A difference of positions of two landmarks, given by their indices.
struct Span
{
  const HeadTemplate::Dimension* dimension;
  std::size_t from, to;
  double wanted;
};

}  // namespace

std::string words_for(const std::map<std::string, double>& dimensions)
{
  std::string words;
  for (const auto& [name, value] : dimensions)
    words += fmt::format("{}'{}' {:.1f} mm", words.empty() ? "" : ", ", name, 1e3 * value);
  return words;
}

HeadWarp::HeadWarp(const HeadTemplate& head, const std::map<std::string, Vector3d>& landmarks,
                   const std::map<std::string, double>& wanted)
{
  std::map<std::string, std::size_t> left, right;
  for (const auto& [name, p] : landmarks)
  {
    left[name] = right[name] = places_.size();
    places_.push_back(p);
    if (p[1] != 0)
    {
      right[name] = places_.size();
      places_.push_back(mirrored(p));
    }
  }
  weights_.assign(places_.size(), Vector3d::Zero());

  std::vector<std::string> known;
  for (const auto& d : head.dimensions)
    known.push_back(d.name);
  for (const auto& [name, value] : wanted)
  {
    const auto d = std::find_if(head.dimensions.begin(), head.dimensions.end(),
                                [&n = name](const auto& entry) { return entry.name == n; });
    if (d == head.dimensions.end())
      throw failure("head: there is no dimension '{}'; there are {}", name, fmt::join(known, ", "));
    if (std::abs(value - d->mean) > most_deviations * d->deviation + 0.05e-3)  // as the message rounds
      throw failure("head: dimension '{}' is {:.1f} mm; must be {:.1f} to {:.1f} mm", name, 1e3 * value,
                    1e3 * (d->mean - most_deviations * d->deviation), 1e3 * (d->mean + most_deviations * d->deviation));
  }
  // A dimension of one side is prescribed on both sides, so that the field is symmetric.
  std::vector<Span> spans;
  const auto measure = [](const std::vector<Vector3d>& places, std::size_t from, std::size_t to)
  { return (places[to] - places[from]).norm(); };
  // Dimensions that are not given keep the value of the default head.
  const auto value_of = [&](const HeadTemplate::Dimension& d)
  {
    const auto given = wanted.find(d.name);
    const std::size_t to = d.to.empty() ? right[d.from] : left[d.to];
    return given != wanted.end() ? given->second : measure(places_, left[d.from], to);
  };
  for (const auto& d : head.dimensions)
    if (d.derived_from.empty())
    {
      spans.push_back({ &d, left[d.from], d.to.empty() ? right[d.from] : left[d.to], value_of(d) });
      if (!d.to.empty() && (left[d.from] != right[d.from] || left[d.to] != right[d.to]))
        spans.push_back({ &d, right[d.from], right[d.to], value_of(d) });
    }

  const auto n = static_cast<Eigen::Index>(places_.size());
  const auto m = static_cast<Eigen::Index>(spans.size());
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      k(i, j) = covariance((places_[i] - places_[j]).norm());
  std::vector<Vector3d> moved = places_;
  for (int iteration = 0; iteration < iterations; ++iteration)
  {
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(m, 3 * n);
    Eigen::VectorXd missing(m);
    for (Eigen::Index s = 0; s < m; ++s)
    {
      const Span& span = spans[s];
      const Vector3d along = (moved[span.to] - moved[span.from]).normalized();
      jacobian.block<1, 3>(s, 3 * static_cast<Eigen::Index>(span.to)) = along.transpose();
      jacobian.block<1, 3>(s, 3 * static_cast<Eigen::Index>(span.from)) = -along.transpose();
      missing[s] = span.wanted - measure(moved, span.from, span.to);
    }
    Eigen::MatrixXd spread(m, 3 * n);  // the Jacobian times the covariance
    for (int a = 0; a < 3; ++a)
    {
      Eigen::MatrixXd part(m, n);
      for (Eigen::Index i = 0; i < n; ++i)
        part.col(i) = jacobian.col(3 * i + a);
      part = part * k;
      for (Eigen::Index i = 0; i < n; ++i)
        spread.col(3 * i + a) = part.col(i);
    }
    const Eigen::VectorXd multipliers = (spread * jacobian.transpose()).ldlt().solve(missing);
    const Eigen::VectorXd step = jacobian.transpose() * multipliers;
    for (Eigen::Index i = 0; i < n; ++i)
      weights_[i] += step.segment<3>(3 * i);
    for (Eigen::Index i = 0; i < n; ++i)
      moved[i] = (*this)(places_[i]);
  }
  if (const auto level = left.find(level_landmark); level != left.end())
    lift_ = places_[level->second][2] - moved[level->second][2];
  for (const Span& span : spans)
    if (std::abs(measure(moved, span.from, span.to) - span.wanted) > 0.5 * derived_tolerance)
      throw failure("head: {} cannot be had together with '{}' {:.1f} mm; take values nearer to the means",
                    words_for(wanted), span.dimension->name, 1e3 * span.wanted);
  for (const auto& d : head.dimensions)
  {
    const auto given = wanted.find(d.name);
    if (d.derived_from.empty() || given == wanted.end())
      continue;
    const double follows = measure(moved, left[d.from], d.to.empty() ? right[d.from] : left[d.to]);
    if (std::abs(follows - given->second) > derived_tolerance)
      throw failure(
          "head: dimension '{}' is {:.1f} mm, but it follows from '{}', which give{} {:.1f} mm; set {} instead", d.name,
          1e3 * given->second, fmt::join(d.derived_from, "' and '"), d.derived_from.size() > 1 ? "" : "s",
          1e3 * follows, d.derived_from.size() > 1 ? "one of those" : "that one");
  }
}

Vector3d HeadWarp::operator()(const Vector3d& p) const
{
  Vector3d sum = p + lift_ * Vector3d::UnitZ();
  for (std::size_t i = 0; i < places_.size(); ++i)
    sum += covariance((p - places_[i]).norm()) * weights_[i];
  return sum;
}

double HeadWarp::volume_ratio(const Vector3d& p) const
{
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < places_.size(); ++i)
    gradient += weights_[i] * covariance_gradient(p - places_[i]).transpose();
  return gradient.determinant();
}

}  // namespace frontalis

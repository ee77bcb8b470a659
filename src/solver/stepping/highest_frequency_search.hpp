#pragma once

#include "solver/stepping/added_mass.hpp"
#include "solver/stepping/added_stiffness_matrix.hpp"

#include <array>
#include <functional>
#include <vector>

namespace frontalis
{

/// The tridiagonal matrix of a Lanczos iteration. Its largest eigenvalue approaches that of the iterated matrix from
/// below (Golub & Van Loan, Matrix Computations, 4th ed., section 10.1).
class LanczosMatrix
{
public:
  /// Adds the row of an iteration. `diagonal`: the product of the vector with its image. `beside`: length of what
  /// remains of the image without its parts along the vector and the vector before, the next element beside the
  /// diagonal.
  void add_row(double diagonal, double beside);
  std::size_t rows() const { return diagonal_.size(); }
  /// NaN without rows, or if an element is not finite.
  double largest_eigenvalue() const;
  struct Eigenpair
  {
    double value;
    std::vector<double> vector;  ///< one component per row; of length 1
  };
  /// The eigenvalues above a number, with their eigenvectors. None if an element is not finite.
  std::vector<Eigenpair> eigenpairs_above(double number) const;
  /// Whether further rows would change the largest eigenvalue by little, or by nothing that makes sense.
  bool settled() const;

private:
  std::vector<double> diagonal_, beside_;
  std::vector<double> largest_;  // eigenvalue of the first, first two, first three, ... rows
};

/// Largest number of iterations of a search. With as many, the eigenvalue of 100,000 unknowns is expected to be at most
/// 7 % too low, whatever the matrix (Kuczynski & Wozniakowski 1992, SIAM J. Matrix Anal. Appl. 13:1094).
constexpr int most_lanczos_iterations = 32;

/// random_mode() returns the start of a search, and mode_amplitude() the largest displacement [m] in a product. Single
/// precision resolves this displacement, and over its length the laws are nearly linear. Its sign alternates, so that
/// the curvature of a law does not raise all products.
std::vector<std::array<double, 3>> random_mode(std::size_t nodes);
double mode_amplitude(const Model& model, int iteration);

/// Square root of each node's inverse mass in the search [kg^-1/2]. A master has the mass of its group, and nodes that
/// are held or follow a master have 0.
std::vector<double> roots_for_search(const Discretisation& discretisation);

/// The search of backends in host memory for the highest frequency: the largest eigenvalue of M^-1/2 K M^-1/2 by
/// Lanczos iteration. Products with the stiffness of voxels are differences of internal forces and therefore include
/// every law and fibre; those with Discretisation::added are exact. Held nodes do not move, and held attached nodes
/// follow their masters. Other constraints could only lower the frequency and are omitted.
template <class Real>
class HighestFrequencySearch
{
public:
  using Components = std::array<std::vector<Real>, 3>;
  /// What the search needs of a backend.
  struct Forces
  {
    /// Writes the internal forces [N] at displacements [m] to `found`, on the nodes of the calling thread.
    std::function<void(const Components& displacements)> find;
    const Components& found;
    std::function<void()> barrier;  ///< waits for all threads
  };

  /// `first_node`: of each part of the model, and the number of all nodes. A thread processes whole parts, and sums are
  /// added part by part, so that the number of threads does not change them. `entries`: length of the lists of
  /// components, at least the number of nodes.
  HighestFrequencySearch(const Model& model, const Discretisation& discretisation, std::vector<std::int32_t> first_node,
                         std::size_t entries);

  /// Squared highest frequency [1/s2] at displacements u. NaN if no node can move or a force is not finite. Each thread
  /// calls this function with its nodes [first, end), and all receive the same number.
  double run(std::int32_t first, std::int32_t end, const Components& u, const Forces& forces);
  /// Value of StepBackend::modes_above(), of the latest run().
  std::vector<FoundMode> modes_above(double frequency_squared);
  /// Called after Discretisation::node_mass has changed.
  void masses_changed(const Discretisation& discretisation);
  void list_arrays(ArrayList& list) const;

private:
  struct Size
  {
    double squared_length = 0, largest = 0;  // of a vector, and of its displacements
  };
  struct Nodes
  {
    std::int32_t first, end;
  };
  Nodes nodes(std::size_t part) const { return { first_node_[part], first_node_[part + 1] }; }
  std::size_t part_of(std::int32_t node) const;
  Size total_size() const;
  /// The vector of an iteration. If they are not kept, those of every other iteration share memory.
  Components& vector(int iteration)
  {
    return iteration == 0 ? start_ : vectors_[keeps_vectors_ ? iteration - 1 : (iteration - 1) % 2];
  }
  void make_room(int iteration);
  void displace(const Nodes& nodes, const Components& u, Real scale, const Components& now);
  void find_image(const Nodes& nodes, const Components& forces, Real factor, Real back, const Components& before,
                  Components& after) const;
  void add_followers(const Nodes& nodes, const Components& forces, Real factor, Components& image) const;
  double product(const Nodes& nodes, const Components& a, const Components& b) const;
  void subtract(const Nodes& nodes, Real share, const Components& now, Components& from, Size& size) const;

  const Model& model_;
  std::vector<std::int32_t> first_node_;  // of each part
  std::vector<Real> root_;
  std::vector<Discretisation::Follower> followers_;  // in the order of their masters
  AddedStiffnessMatrix added_;
  Components start_, moved_, present_;
  std::vector<Components> vectors_;  // of the iterations after the first; they stay where they are
  std::vector<Size> size_;           // of each part of a vector
  std::vector<double> along_;        // products of the parts of a vector with those of its image
  // for modes_above(), in models with MassScalingSettings::in_motion
  bool keeps_vectors_;
  std::vector<double> lengths_;  // of the vectors
  LanczosMatrix matrix_;
};

}  // namespace frontalis

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cattaneo/algebra/sparse_eigenpairs.hpp>
#include <cattaneo/algebra/sparse_factor.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/joints/vibration.hpp>
#include <cattaneo/reduced/contact_motions.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

SparseView view_of(const RowMatrix &A)
{
   return {A.rows(),          A.cols(),          A.nonZeros(),
           A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr()};
}

/// The dofs of a body's contact nodes, {x; y} or {x; y; z}.
std::vector<int> contact_dofs_of(const CondensedBody &body)
{
   const auto n = static_cast<int>(body.nodes());
   const int components = cattaneo::components(body.line.formulation);
   std::vector<int> dofs;
   for (int c = 0; c < components; ++c)
   {
      for (int i = 0; i < n; ++i)
      {
         dofs.push_back(body.line.formulation == Formulation::space
                           ? body.surface.nodes[i].dofs[c]
                           : body.line.nodes[i].dofs[c]);
      }
   }
   return dofs;
}

std::string name_of_mode(Index k)
{
   return "mode " + std::to_string(k + 1);
}

/// Supports that the program which wrote K has eliminated are fixed, as condense() has them.
void hold_eliminated_rows(AssembledBody &body)
{
   if (!body.grounded) { return; }
   const std::vector<int> rows = body.eliminated();
   std::vector<int> all;
   std::set_union(body.fixed.begin(), body.fixed.end(), rows.begin(), rows.end(),
                  std::back_inserter(all));
   body.fixed = std::move(all);
}

/// The place and the direction of a dof, for messages.
std::string called(const DofPlaces &places, int dof)
{
   const bool axis = places.formulation == Formulation::axisymmetric;
   const char *direction = axis ? "rz" : "xyz";
   return places.called(dof) + " along " + direction[places.component[dof]];
}

/// InputError unless the mass of a body is symmetric, positive definite on the dofs that move,
/// and the same along all axes.
void check_mass(std::size_t b, const VibratingBody &body)
{
   const AssembledBody &its = body.body;
   // 1. Dofs that move. Those without a mass are refused later if they have a stiffness.
   std::vector<int> moving;
   for (int dof = 0; dof < its.K.size(); ++dof)
   {
      const bool fixed = std::binary_search(its.fixed.begin(), its.fixed.end(), dof);
      if (!fixed && body.M.diagonal(dof) != 0) { moving.push_back(dof); }
   }
   // 2. Symmetric and definite.
   const RowMatrix M = body.M.view(), turned = M.transpose();
   const double most =
      M.nonZeros() > 0
         ? Eigen::Map<const VectorXd>(M.valuePtr(), M.nonZeros()).lpNorm<Eigen::Infinity>()
         : 0;
   const RowMatrix skew = M - turned;
   for (Index row = 0; row < skew.rows(); ++row)
   {
      for (RowMatrix::InnerIterator it(skew, row); it; ++it)
      {
         require(std::abs(it.value()) <= 1e-9 * most, "vibration: body ", b,
                 ": its mass is not symmetric, it must be: entries (", row, ", ", it.col(),
                 ") and (", it.col(), ", ", row, ") differ by ", it.value());
      }
   }
   if (moving.empty()) { return; }
   try
   {
      const SparseFactor factor(body.M.view(), moving, 0, 0.0);
   }
   catch (const NotPositiveDefinite &failure)
   {
      throw InputError(
         "vibration: body " + std::to_string(b) + ": its mass is not positive definite at " +
         called(its.places, failure.row) + " (row " + std::to_string(failure.row) +
         "), it must be: a motion has no mass, or a negative one");
   }
   // 3. Translations along all axes move the same mass. About an axis a radial displacement is
   // no common motion, and a node that lacks the mass of a support says nothing.
   if (its.places.formulation == Formulation::axisymmetric) { return; }
   const auto axes = static_cast<std::size_t>(cattaneo::components(its.places.formulation));
   std::map<std::array<double, 3>, std::array<int, 3>> at;
   MatrixXd along = MatrixXd::Zero(M.rows(), static_cast<Index>(axes));
   for (int dof = 0; dof < its.K.size(); ++dof)
   {
      const Eigen::Vector3d place = its.places.place(dof);
      const int component = its.places.component[dof];
      along(dof, component) = 1;
      at[{place[0], place[1], place[2]}][component] += body.M.diagonal(dof) != 0;
   }
   for (const auto &[place, count] : at)
   {
      for (std::size_t c = 1; c < axes; ++c)
      {
         if (count[c] != count[0]) { return; }
      }
   }
   const MatrixXd moved = along.transpose() * (M * along);
   const double wrong = (moved - moved(0, 0) * MatrixXd::Identity(moved.rows(), moved.cols()))
                           .cwiseAbs()
                           .maxCoeff();
   std::ostringstream masses;
   masses << moved.diagonal().transpose();
   require(wrong <= 1e-6 * moved.diagonal().maxCoeff(), "vibration: body ", b,
           ": translations along its axes move the masses ", masses.str(),
           ", and they couple by ", moved(0, 1),
           ", must be one mass and 0: are the rows of the mass those of the stiffness?");
}

/// Round-off of a quadratic form xᵀ A x, by the sizes of its terms.
bool is_round_off(const RowMatrix &A, const VectorXd &x, double value)
{
   double terms = 0;
   for (Index row = 0; row < A.rows(); ++row)
   {
      for (RowMatrix::InnerIterator it(A, row); it; ++it)
      {
         terms += std::abs(x[row] * it.value() * x[it.col()]);
      }
   }
   return std::abs(value) <= 1e-12 * terms;
}

} // namespace

GluedRows glued_rows(const ReducedProblem &problem, const ContactState &state)
{
   const Index n = problem.nodes(), m = problem.slips();
   GluedRows glued(m + n, false);
   for (Index i = 0; i < n; ++i)
   {
      // A node that touches without a force counts as open.
      if (!closed(state.status[i]) || state.p[i] <= 0) { continue; }
      glued[m + i] = true;
      for (Index row = i; row < m; row += n) { glued[row] = problem.friction[i] > 0; }
   }
   for (const Index row : problem.held) { glued[row] = true; }
   return glued;
}

int nodes_at_limit(const ReducedProblem &problem, const ContactState &state)
{
   int count = 0;
   for (Index i = 0; i < problem.nodes(); ++i)
   {
      count += slips(state.status[i]) && problem.friction[i] > 0;
   }
   return count;
}

struct VibratingStructure::Parts
{
   std::vector<VibratingBody> bodies;
   std::vector<double> thickness;  ///< of each body
   std::vector<RowMatrix> motions; ///< of each body: dofs × coordinates
   RowMatrix K, M;                 ///< of all coordinates
   std::vector<int> rest;          ///< coordinates that are not relative displacements
   std::vector<int> relative;      ///< coordinate of each row {v; w} of the problem, -1: held

   /// Forces on the dofs of all bodies as forces on the coordinates.
   VectorXd on_coordinates(const std::vector<VectorXd> &forces) const
   {
      VectorXd sum = VectorXd::Zero(K.rows());
      for (std::size_t b = 0; b < forces.size(); ++b)
      {
         sum += motions[b].transpose() * forces[b];
      }
      return sum;
   }
   void add_body(const Reduction &reduction, const ContactMotions &contact, std::size_t b,
                 int first_column, int columns);
   /// A coordinate in a sentence, by the first dof that it moves.
   std::string called(int coordinate) const;
   void add_shank(const Reduction &reduction, const Bolt &bolt);
   /// The bodies and shanks must be those of the reduction.
   void check(Reduction &reduction, const std::vector<Bolt> &shanks) const;
   /// Forces of a load on the dofs of each body, per unit multiplier; empty if none has it.
   std::vector<VectorXd> forces_of(const std::string &load) const;
   /// The displacements of all coordinates except the relative displacements, K_rr⁻¹ f_r.
   /// Motions that nothing resists are left at rest.
   class Answer;
   void check(const ReducedProblem &problem, const Answer &answer) const;
};

/// Solves with the stiffness of the coordinates that are not relative displacements: all
/// contact nodes are clamped.
class VibratingStructure::Parts::Answer
{
public:
   Answer(const Parts &parts, const MatrixXd &rigid)
      : parts_(parts), keep_(without_pins(parts, rigid)),
        factor_(view_of(parts.K), keep_, 0, 0.0)
   {
   }
   /// Displacements of all coordinates, one column for each of the forces; those at rest are 0.
   MatrixXd solve(const MatrixXd &forces) const
   {
      MatrixXd x = MatrixXd::Zero(parts_.K.rows(), forces.cols());
      x(keep_, Eigen::all) = factor_.solve(MatrixXd(forces(keep_, Eigen::all)));
      return x;
   }

private:
   /// If the structure floats, as many coordinates are held as it has free motions. Loads on it
   /// balance each other, so that held coordinates carry no force.
   static std::vector<int> without_pins(const Parts &parts, const MatrixXd &rigid)
   {
      if (rigid.cols() == 0) { return parts.rest; }
      const MatrixXd rows = rigid(parts.rest, Eigen::all);
      const Eigen::ColPivHouseholderQR<MatrixXd> qr(rows.transpose());
      std::vector<bool> pinned(parts.rest.size(), false);
      for (Index k = 0; k < rigid.cols(); ++k)
      {
         pinned[qr.colsPermutation().indices()[k]] = true;
      }
      std::vector<int> keep;
      for (std::size_t k = 0; k < parts.rest.size(); ++k)
      {
         if (!pinned[k]) { keep.push_back(parts.rest[k]); }
      }
      return keep;
   }

   const Parts &parts_;
   std::vector<int> keep_;
   SparseFactor factor_;
};

/// The columns of a body: each dof beyond the contact is a coordinate of its own, as is each
/// block; the coordinates of the contact come after those of all bodies.
void VibratingStructure::Parts::add_body(const Reduction &reduction,
                                         const ContactMotions &contact, std::size_t b,
                                         int first_column, int columns)
{
   const AssembledBody &body = bodies[b].body;
   const std::vector<int> dofs = contact_dofs_of(reduction.bodies[b]);
   std::vector<bool> other(body.K.size(), true); // neither fixed nor in contact
   for (int dof : body.fixed) { other[dof] = false; }
   for (int dof : dofs)
   {
      if (dof >= 0) { other[dof] = false; }
   }
   std::vector<Eigen::Triplet<double>> entries;
   int column = first_column;
   for (int dof = 0; dof < body.K.size(); ++dof)
   {
      if (other[dof]) { entries.emplace_back(dof, column++, 1.0); }
   }
   for (const BlockMotion &block : body.blocks)
   {
      for (int dof : body.fixed)
      {
         if (block.motion[dof] != 0) { entries.emplace_back(dof, column, block.motion[dof]); }
      }
      ++column;
   }
   const int behind = columns - contact.coordinates;
   const Eigen::SparseMatrix<double> &its = contact.of_body[b];
   for (Index c = 0; c < its.outerSize(); ++c)
   {
      for (Eigen::SparseMatrix<double>::InnerIterator it(its, c); it; ++it)
      {
         const int dof = dofs[it.row()];
         if (std::binary_search(body.fixed.begin(), body.fixed.end(), dof)) { continue; }
         entries.emplace_back(dof, behind + static_cast<int>(c), it.value());
      }
   }
   motions.emplace_back(body.K.size(), columns);
   motions.back().setFromTriplets(entries.begin(), entries.end());
   const RowMatrix &Z = motions.back();
   const RowMatrix KZ = thickness[b] * (body.K.view() * Z),
                   MZ = thickness[b] * (bodies[b].M.view() * Z);
   K += RowMatrix(Z.transpose() * KZ);
   M += RowMatrix(Z.transpose() * MZ);
}

std::string VibratingStructure::Parts::called(int coordinate) const
{
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const RowMatrix moved = motions[b].middleCols(coordinate, 1);
      const DofPlaces &places = bodies[b].body.places;
      for (Index dof = 0; dof < moved.rows(); ++dof)
      {
         if (moved.innerVector(dof).nonZeros() == 0) { continue; }
         std::ostringstream text;
         text << "the dof " << dof << " of body " << b << " at (" << places.x[dof] << ", "
              << places.y[dof];
         if (places.z.size() > 0) { text << ", " << places.z[dof]; }
         text << ")";
         return text.str();
      }
   }
   return "a dof";
}

namespace
{

/// Bodies must be those of the reduction, in its order: their contact nodes are at the same
/// places.
void require_same_places(const CondensedBody &reduced, const AssembledBody &body, std::size_t b)
{
   const bool space = reduced.line.formulation == Formulation::space;
   const auto place = [&](Index node)
   {
      Eigen::Vector3d at(0, 0, 0);
      if (space) { at = reduced.surface.nodes[node].position; }
      else { at.head<2>() = reduced.line.nodes[node].position; }
      return at;
   };
   const std::vector<int> dofs = contact_dofs_of(reduced);
   const Index n = reduced.nodes();
   double size = 0;
   for (Index node = 0; node < n; ++node) { size = std::max(size, place(node).norm()); }
   for (std::size_t k = 0; k < dofs.size(); ++k)
   {
      if (dofs[k] < 0) { continue; }
      bool same = dofs[k] < body.K.size();
      if (same)
      {
         const DofPlaces &places = body.places;
         const Eigen::Vector3d its(places.x[dofs[k]], places.y[dofs[k]],
                                   space ? places.z[dofs[k]] : 0);
         same = (its - place(static_cast<Index>(k) % n)).norm() <= 1e-6 * size;
      }
      require(same, "vibration: contact nodes of body ", b,
              " are at other places than those of the reduction's body ", b,
              ", must be at the same ones: bodies must be in the order of the reduction");
   }
}

} // namespace

std::vector<VectorXd> VibratingStructure::Parts::forces_of(const std::string &load) const
{
   std::vector<VectorXd> forces;
   bool found = false;
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      forces.emplace_back(VectorXd::Zero(bodies[b].body.K.size()));
      for (const BodyLoad &each : bodies[b].body.loads)
      {
         if (each.name != load || each.control != Control::force) { continue; }
         forces.back() += thickness[b] * each.values;
         found = true;
      }
   }
   return found ? forces : std::vector<VectorXd>();
}

/// A spring on the load's forces: stiffness · F Fᵀ.
void VibratingStructure::Parts::add_shank(const Reduction &reduction, const Bolt &bolt)
{
   require(bolt.stiffness > 0 && std::isfinite(bolt.stiffness), "vibration: the shank of '",
           bolt.load, "' has the stiffness ", bolt.stiffness, ", must be positive");
   const std::vector<VectorXd> forces = forces_of(bolt.load);
   require(
      !forces.empty(), "vibration: no body has the load '", bolt.load,
      "' of a bolt, one must (loads: ",
      [&]
      {
         std::string all;
         for (const LoadPattern &pattern : reduction.problem.patterns)
         {
            all += (all.empty() ? "" : ", ") + pattern.name;
         }
         return all;
      }(),
      ")");
   const VectorXd F = on_coordinates(forces);
   const Eigen::SparseVector<double> sparse = F.sparseView();
   std::vector<Eigen::Triplet<double>> entries;
   for (Eigen::SparseVector<double>::InnerIterator i(sparse); i; ++i)
   {
      for (Eigen::SparseVector<double>::InnerIterator j(sparse); j; ++j)
      {
         entries.emplace_back(static_cast<int>(i.index()), static_cast<int>(j.index()),
                              bolt.stiffness * i.value() * j.value());
      }
   }
   RowMatrix spring(K.rows(), K.cols());
   spring.setFromTriplets(entries.begin(), entries.end());
   K += spring;
}

/// The stiffness of the problem must agree with that of the bodies, for one displacement of all
/// nodes.
void VibratingStructure::Parts::check(const ReducedProblem &problem, const Answer &answer) const
{
   const auto rows = static_cast<Index>(relative.size());
   VectorXd u = VectorXd::Zero(rows), x = VectorXd::Zero(K.rows());
   for (Index row = 0; row < rows; ++row)
   {
      if (relative[row] < 0) { continue; }
      u[row] = std::sin(1.0 + static_cast<double>(row));
      x[relative[row]] = u[row];
   }
   x -= answer.solve(K * x);
   const VectorXd f = K * x, expected = problem.K * u;
   double difference = 0;
   for (Index row = 0; row < rows; ++row)
   {
      if (relative[row] < 0) { continue; }
      difference = std::max(difference, std::abs(f[relative[row]] - expected[row]));
   }
   require(difference <= 1e-6 * expected.cwiseAbs().maxCoeff(),
           "vibration: the stiffness of the bodies is not that of the reduced problem (by ",
           difference / expected.cwiseAbs().maxCoeff(),
           " of it), must be: no obstacle may be free to move, since it has no mass");
}

/// For one displacement of all contact nodes, the bodies move as the reduction says. Then their
/// stiffness must give the forces of the problem on these nodes, and none elsewhere.
void VibratingStructure::Parts::check(Reduction &reduction,
                                      const std::vector<Bolt> &shanks) const
{
   // 1. The bodies move.
   const ReducedProblem &problem = reduction.problem;
   const auto rows = static_cast<Index>(relative.size());
   VectorXd u = VectorXd::Zero(rows);
   for (Index row = 0; row < rows; ++row)
   {
      if (relative[row] >= 0) { u[row] = std::sin(1.0 + static_cast<double>(row)); }
   }
   const VectorXd at_rest = VectorXd::Zero(static_cast<Index>(problem.patterns.size()));
   std::vector<VectorXd> moved, forces;
   double apart = 0; // displacement of supports
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const AssembledBody &body = bodies[b].body;
      moved.push_back(reduction.displacement(static_cast<int>(b), u.head(problem.slips()),
                                             u.tail(problem.nodes()), at_rest));
      require(moved[b].size() == body.K.size(), "vibration: body ", b, " has ", body.K.size(),
              " rows, that of the reduction has ", moved[b].size(),
              ", must be the same body: bodies must have the order of the reduction");
      for (const int dof : body.fixed)
      {
         if (body.blocks.empty()) { apart = std::max(apart, std::abs(moved[b][dof])); }
      }
      forces.emplace_back(thickness[b] * (body.K.view() * moved[b]));
   }
   // 2. The forces on the coordinates, with those of the shanks.
   VectorXd f = on_coordinates(forces);
   for (const Bolt &bolt : shanks)
   {
      const std::vector<VectorXd> F = forces_of(bolt.load);
      double approach = 0;
      for (std::size_t b = 0; b < bodies.size(); ++b) { approach += F[b].dot(moved[b]); }
      f += bolt.stiffness * approach * on_coordinates(F);
   }
   const VectorXd expected = problem.K * u;
   double difference = rest.empty() ? 0 : f(rest).lpNorm<Eigen::Infinity>();
   for (Index row = 0; row < rows; ++row)
   {
      if (relative[row] < 0) { continue; }
      difference = std::max(difference, std::abs(f[relative[row]] - expected[row]));
   }
   difference /= expected.lpNorm<Eigen::Infinity>();
   require(difference <= 1e-6 && apart <= 1e-9 * u.lpNorm<Eigen::Infinity>(),
           "vibration: the stiffness or the supports of the bodies are not those of the "
           "reduced problem (forces differ by ",
           difference,
           " of the largest), must be: bodies must have the order of the reduction and be as "
           "they were condensed, and all bolts that are springs must be named with their "
           "stiffness (the reduction of a BoltedJoint is its tightened())");
}

VibratingStructure::VibratingStructure(Reduction &reduction, std::vector<VibratingBody> bodies,
                                       const std::vector<Bolt> &shanks)
   : parts_(std::make_unique<Parts>()), reduction_(reduction)
{
   require(bodies.size() == reduction.bodies.size(), "vibration: ", bodies.size(),
           " bodies have a mass, the reduction has ", reduction.bodies.size(),
           ", must be as many (a half-plane has none)");
   const ContactMotions contact = contact_motions(reduction);
   Parts &parts = *parts_;
   parts.bodies = std::move(bodies);
   int own = 0;            // coordinates that do not belong to the contact
   std::vector<int> first; // of each body
   for (std::size_t b = 0; b < parts.bodies.size(); ++b)
   {
      const AssembledBody &body = parts.bodies[b].body;
      require(body.K.size() > 0 && parts.bodies[b].M.size() == body.K.size(),
              "vibration: body ", b, " has a stiffness of ", body.K.size(),
              " rows and a mass of ", parts.bodies[b].M.size(),
              ", must be as many and more than none");
      require_same_places(reduction.bodies[b], body, b);
      hold_eliminated_rows(parts.bodies[b].body);
      check_mass(b, parts.bodies[b]);
      parts.thickness.push_back(reduction.bodies[b].thickness);
      std::vector<bool> taken(body.K.size(), false);
      for (int dof : body.fixed) { taken[dof] = true; }
      for (int dof : contact_dofs_of(reduction.bodies[b]))
      {
         if (dof >= 0) { taken[dof] = true; }
      }
      first.push_back(own);
      own += static_cast<int>(std::count(taken.begin(), taken.end(), false) +
                              static_cast<long>(body.blocks.size()));
   }
   const int columns = own + contact.coordinates;
   parts.K = parts.M = RowMatrix(columns, columns);
   for (std::size_t b = 0; b < parts.bodies.size(); ++b)
   {
      parts.add_body(reduction, contact, b, first[b], columns);
   }
   for (const Bolt &bolt : shanks) { parts.add_shank(reduction, bolt); }

   std::vector<bool> rest(columns, true);
   for (const int place : contact.relative)
   {
      parts.relative.push_back(place < 0 ? -1 : own + place);
      if (place >= 0) { rest[own + place] = false; }
   }
   for (const int place : contact.tied) { rest[own + place] = false; }
   // Components of the contact that supports hold have no motion.
   const VectorXd diagonal = parts.M.diagonal(), stiff = parts.K.diagonal();
   for (int c = 0; c < columns; ++c)
   {
      const bool has_mass = diagonal[c] > 0 || stiff[c] == 0;
      // Its place is searched for only where it is said.
      require(has_mass, "vibration: ", has_mass ? std::string() : parts.called(c),
              " is not held and has a stiffness but a mass of ", diagonal[c],
              ", must be positive: a small mass there changes low modes little");
      if (rest[c] && diagonal[c] > 0) { parts.rest.push_back(c); }
   }
   parts.check(reduction, shanks);
}

VibratingStructure::~VibratingStructure() = default;

double VibratingStructure::mass() const
{
   double sum = 0;
   for (std::size_t b = 0; b < parts_->bodies.size(); ++b)
   {
      const VibratingBody &body = parts_->bodies[b];
      // Along the last component, because radial displacements about an axis are not a common
      // motion.
      const std::vector<int> &component = body.body.places.component;
      const int last = *std::max_element(component.begin(), component.end());
      VectorXd r = VectorXd::Zero(body.M.size());
      for (Index dof = 0; dof < r.size(); ++dof) { r[dof] = component[dof] == last; }
      sum += parts_->thickness[b] * r.dot(body.M.view() * r);
   }
   return sum;
}

bool VibratingStructure::stiffness_of(const ReducedProblem &problem) const
{
   const MatrixXd &K = reduction_.problem.K;
   return problem.K.rows() == K.rows() && problem.K.cols() == K.cols() &&
          (problem.K - K).cwiseAbs().maxCoeff() <= 1e-9 * K.cwiseAbs().maxCoeff();
}

Modes VibratingStructure::modes(const GluedRows &glued, int count) const
{
   const Parts &parts = *parts_;
   require(count >= 1, "modes: ", count, " are asked for, must be at least one");
   require(glued.size() == parts.relative.size(), "modes: ", glued.size(),
           " rows are glued or not, the problem has ", parts.relative.size(),
           ", must be as many");
   std::vector<int> keep = parts.rest;
   for (std::size_t row = 0; row < glued.size(); ++row)
   {
      if (!glued[row] && parts.relative[row] >= 0) { keep.push_back(parts.relative[row]); }
   }
   // Small compared with the lowest frequencies of a body as long as it is wide, and large
   // compared with the round-off of the highest ones, so that the shifted stiffness is
   // definite.
   double stiff = 0, heavy = 0;
   const VectorXd k = parts.K.diagonal(), m = parts.M.diagonal();
   for (int c : keep)
   {
      stiff += k[c];
      heavy += m[c];
   }
   const double shift = 1e-3 * stiff / heavy / static_cast<double>(keep.size());

   Modes made;
   std::vector<Index> elastic;
   Eigenpairs pairs;
   // Motions that nothing resists come first: ask for more until enough others are found.
   for (int asked = count + 3;; asked += count + 3)
   {
      const int most = static_cast<int>(keep.size()) - 1;
      pairs = lowest_eigenpairs(parts.K, parts.M, keep, std::min(asked, most), shift);
      require(pairs.all, "modes: the Lanczos method did not find ", std::min(asked, most),
              " eigenpairs, must find all: ask for fewer modes");
      elastic.clear();
      std::vector<Index> rigid;
      for (Index j = 0; j < pairs.values.size(); ++j)
      {
         const VectorXd x = pairs.vectors.col(j);
         (is_round_off(parts.K, x, pairs.values[j]) ? rigid : elastic).push_back(j);
      }
      made.rigid = static_cast<int>(rigid.size());
      made.rigid_coordinates = pairs.vectors(Eigen::all, rigid);
      if (static_cast<int>(elastic.size()) >= count) { break; }
      require(asked < most, "modes: ", count, " are asked for, there are ", elastic.size(),
              ", must be no more: ask for fewer");
   }
   elastic.resize(count);
   made.coordinates = pairs.vectors(Eigen::all, elastic);
   made.omega.resize(count);
   made.residuals.resize(count);
   const auto components =
      static_cast<Index>(cattaneo::components(parts.bodies[0].body.places.formulation));
   made.effective_mass = MatrixXd::Zero(count, components);
   const bool axis = parts.bodies[0].body.places.formulation == Formulation::axisymmetric;
   for (Index j = 0; j < count; ++j)
   {
      const VectorXd z = made.coordinates.col(j);
      const double square = pairs.values[elastic[j]];
      made.omega[j] = std::sqrt(square);
      const VectorXd Kz = parts.K * z, Mz = parts.M * z;
      const VectorXd force = Kz(keep), off = force - square * Mz(keep);
      made.residuals[j] = off.norm() / force.norm();
      made.shapes.emplace_back();
      VectorXd moved = VectorXd::Zero(components);
      for (std::size_t b = 0; b < parts.bodies.size(); ++b)
      {
         const VectorXd shape = parts.motions[b] * z,
                        inertia = parts.thickness[b] * (parts.bodies[b].M.view() * shape);
         const std::vector<int> &component = parts.bodies[b].body.places.component;
         for (Index dof = 0; dof < shape.size(); ++dof)
         {
            moved[component[dof]] += inertia[dof];
         }
         made.shapes.back().push_back(shape);
      }
      made.effective_mass.row(j) = moved.array().square().matrix().transpose();
      if (axis) { made.effective_mass(j, 0) = 0; }
   }
   return made;
}

ReducedProblem VibratingStructure::with_modes(const Modes &modes) const
{
   const Parts &parts = *parts_;
   ReducedProblem problem = reduction_.problem;
   const auto loads = static_cast<Index>(problem.patterns.size()), count = modes.omega.size();
   require(problem.knows_loads(), "modes: the response H of the loads is not known, must be");
   for (Index k = 0; k < count; ++k)
   {
      for (const LoadPattern &pattern : problem.patterns)
      {
         require(pattern.name != name_of_mode(k), "modes: a load is called '", pattern.name,
                 "', which is the name of a mode: it must have another");
      }
   }
   // 1. A motion that nothing resists must be one of all bodies together.
   const Index slips = problem.slips(), n = problem.nodes();
   for (Index k = 0; k < modes.rigid_coordinates.cols(); ++k)
   {
      const VectorXd z = modes.rigid_coordinates.col(k);
      for (const int place : parts.relative)
      {
         require(place < 0 || std::abs(z[place]) <= 1e-6 * z.cwiseAbs().maxCoeff(),
                 "modes: a body floats apart from the others at the state about which it "
                 "vibrates, it must be pressed on one of them with friction, or be supported");
      }
   }
   const Parts::Answer answer(parts, modes.rigid_coordinates);
   parts.check(problem, answer);

   // 2. Forces M φ with all contact nodes clamped: the forces on these nodes, and the
   // displacements of the bodies.
   problem.H.conservativeResize(loads + count, loads + count);
   problem.H.bottomRows(count).setZero();
   problem.H.rightCols(count).setZero();
   MatrixXd forces(parts.K.rows(), count), response = forces;
   for (Index k = 0; k < count; ++k)
   {
      forces.col(k) = parts.M * modes.coordinates.col(k);
      response.col(k) = answer.solve(forces.col(k));
      const VectorXd reaction = parts.K * response.col(k) - forces.col(k);
      LoadPattern made{name_of_mode(k), Control::force, VectorXd::Zero(slips),
                       VectorXd::Zero(n)};
      for (Index row = 0; row < slips + n; ++row)
      {
         const int place = parts.relative[row];
         if (place < 0) { continue; }
         (row < slips ? made.q[row] : made.p[row - slips]) = reaction[place];
      }
      problem.patterns.push_back(std::move(made));
   }
   const MatrixXd among = response.transpose() * forces;
   problem.H.bottomRightCorner(count, count) = 0.5 * (among + among.transpose());

   // 3. How far each other load moves along a mode while the contact is clamped.
   const VectorXd v = VectorXd::Zero(slips), w = VectorXd::Zero(n);
   for (Index l = 0; l < loads; ++l)
   {
      const VectorXd one = VectorXd::Unit(loads, l);
      for (std::size_t b = 0; b < parts.bodies.size(); ++b)
      {
         const VectorXd x = reduction_.displacement(static_cast<int>(b), v, w, one);
         const VectorXd Mx = parts.thickness[b] * (parts.bodies[b].M.view() * x);
         for (Index k = 0; k < count; ++k)
         {
            problem.H(loads + k, l) += modes.shapes[k][b].dot(Mx);
         }
      }
      const double sign = problem.patterns[l].control == Control::force ? 1 : -1;
      for (Index k = 0; k < count; ++k)
      {
         problem.H(l, loads + k) = sign * problem.H(loads + k, l);
      }
   }
   return problem;
}

ContactState VibratingStructure::with_modes(const Modes &modes, ContactState state) const
{
   const Index loads = state.multipliers.size(), count = modes.omega.size();
   state.multipliers.conservativeResize(loads + count);
   state.multipliers.tail(count).setZero();
   for (Index k = 0; k < count && !state.loads.empty(); ++k)
   {
      state.loads.push_back(name_of_mode(k));
   }
   return state;
}

CraigBampton VibratingStructure::craig_bampton(int count, double most,
                                               const std::vector<OutputDof> &outputs) const
{
   const Parts &parts = *parts_;
   // 1. Modes with all relative displacements held, after the motions that nothing resists.
   const Modes held = modes(GluedRows(parts.relative.size(), true), count);
   const Index rigid = held.rigid,
               kept = std::count_if(held.omega.begin(), held.omega.end(),
                                    [&](double omega) { return omega <= most; });
   CraigBampton made;
   made.omega = VectorXd::Zero(rigid + kept);
   made.omega.tail(kept) = held.omega.head(kept);
   MatrixXd shapes(parts.K.rows(), rigid + kept);
   shapes << held.rigid_coordinates, held.coordinates.leftCols(kept);
   std::vector<int> contact; // coordinates
   for (std::size_t row = 0; row < parts.relative.size(); ++row)
   {
      if (parts.relative[row] < 0) { continue; }
      made.rows.push_back(static_cast<Index>(row));
      contact.push_back(parts.relative[row]);
   }
   const auto first = static_cast<Index>(contact.size());
   const Index size = first + made.omega.size();
   made.K = MatrixXd::Zero(size, size);
   made.M = MatrixXd::Identity(size, size); // of the modes among each other
   made.K.diagonal().tail(made.omega.size()) = made.omega.cwiseAbs2();

   // 2. Forces on all coordinates do work with a unit of each coordinate of the contact, at
   // which the others follow without forces, x_r = -K_rr⁻¹ K_rc, and with the modes.
   const Parts::Answer answer(parts, held.rigid_coordinates);
   parts.check(reduction_.problem, answer);
   const auto on_kept = [&](const MatrixXd &forces)
   {
      MatrixXd all(size, forces.cols());
      const MatrixXd following = parts.K * answer.solve(forces);
      all.topRows(first) = forces(contact, Eigen::all) - following(contact, Eigen::all);
      all.bottomRows(size - first) = shapes.transpose() * forces;
      return all;
   };
   // 3. Columns of K and M, some at a time, because the displacements of all dofs for all of
   // them would not fit into memory.
   constexpr Index at_once = 64;
   for (Index begin = 0; begin < first; begin += at_once)
   {
      const Index columns = std::min(at_once, first - begin);
      MatrixXd x = MatrixXd::Zero(parts.K.rows(), columns);
      for (Index k = 0; k < columns; ++k) { x(contact[begin + k], k) = 1; }
      x -= answer.solve(parts.K * x);
      const MatrixXd force = parts.K * x;
      made.K.block(0, begin, first, columns) = force(contact, Eigen::all);
      const MatrixXd inertia = on_kept(parts.M * x);
      made.M.block(0, begin, size, columns) = inertia;
      made.M.block(begin, first, columns, size - first) =
         inertia.bottomRows(size - first).transpose();
   }
   made.K = MatrixXd(0.5 * (made.K + made.K.transpose()));
   made.M = MatrixXd(0.5 * (made.M + made.M.transpose()));

   // 4. Loads, and displacements of outputs.
   for (const LoadPattern &pattern : reduction_.problem.patterns)
   {
      const std::vector<VectorXd> forces = parts.forces_of(pattern.name);
      if (forces.empty()) { continue; }
      made.loads.push_back(pattern.name);
      made.F.conservativeResize(size, static_cast<Index>(made.loads.size()));
      made.F.rightCols(1) = on_kept(parts.on_coordinates(forces));
   }
   made.R.resize(static_cast<Index>(outputs.size()), size);
   for (std::size_t k = 0; k < outputs.size(); ++k)
   {
      const auto [b, dof] = outputs[k];
      require(b >= 0 && b < static_cast<int>(parts.bodies.size()) && dof >= 0 &&
                 dof < parts.motions[b].rows(),
              "output ", k, " is dof ", dof, " of body ", b, ", must be one of a body");
      const VectorXd row = parts.motions[b].row(dof).transpose();
      made.R.row(static_cast<Index>(k)) = on_kept(row).transpose();
   }
   return made;
}

} // namespace cattaneo

#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/algebra/semidefinite.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <set>

namespace cattaneo
{

bool ContactChain::mirrored_at(std::size_t end) const
{
   // A rigid obstacle (bodies[1] < 0) has no end, so only the first side must be symmetric.
   return !loop && ends[end] == LineEnd::symmetry &&
          (bodies[1] < 0 || other_ends[end] == LineEnd::symmetry);
}

void ReducedProblem::set_stiffness(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B,
                                   const Eigen::MatrixXd &C, const Eigen::MatrixXd &motions)
{
   const Eigen::Index m = A.rows(), n = C.rows();
   require(A.cols() == m && B.rows() == n && B.cols() == m && C.cols() == n,
           "reduced problem: sizes of A (", m, "×", A.cols(), "), B (", B.rows(), "×", B.cols(),
           ") and C (", n, "×", C.cols(), ") do not fit, must be m × m, n × m and n × n");
   K.resize(m + n, m + n);
   K << A, B.transpose(), B, C;
   if (gap.size() != n) { gap = Eigen::VectorXd::Zero(n); }
   if (friction.size() != n) { friction = Eigen::VectorXd::Zero(n); }
   rigid_motions = motions;
   join_coupling(*this);
}

void ReducedProblem::set_stiffness(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B,
                                   const Eigen::MatrixXd &C)
{
   set_stiffness(A, B, C, {});
   complete(*this);
   require_semidefinite(*this);
}

std::vector<std::string> ReducedProblem::load_names() const
{
   std::vector<std::string> names;
   for (const LoadPattern &pattern : patterns) { names.push_back(pattern.name); }
   return names;
}

int ReducedProblem::pattern(const std::string &name) const
{
   const std::vector<std::string> known = load_names();
   const auto found = std::find(known.begin(), known.end(), name);
   require(found != known.end(), "reduced problem: there is no load pattern '", name,
           "', must be one of: ", listed(known));
   return static_cast<int>(found - known.begin());
}

Eigen::VectorXd ReducedProblem::multipliers(const NamedLoads &loads) const
{
   Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(patterns.size()));
   for (const auto &[name, value] : loads) { result[pattern(name)] = value; }
   return result;
}

Eigen::VectorXd ReducedProblem::clamped_forces(const Eigen::VectorXd &multipliers) const
{
   require(multipliers.size() == static_cast<Eigen::Index>(patterns.size()),
           "reduced problem: ", multipliers.size(),
           " load multipliers, must be one for each of the ", patterns.size(),
           " load patterns");
   const Eigen::Index m = slips();
   Eigen::VectorXd f = Eigen::VectorXd::Zero(m + nodes());
   for (std::size_t k = 0; k < patterns.size(); ++k)
   {
      f.head(m) += multipliers[k] * patterns[k].q;
      f.tail(nodes()) += multipliers[k] * patterns[k].p;
   }
   return f;
}

namespace
{

void check_symmetric(const char *name, const Eigen::Ref<const Eigen::MatrixXd> &M)
{
   if (M.size() == 0) { return; }
   const double allowed = 1e-9 * M.cwiseAbs().maxCoeff(), skew = largest_skew(M, M);
   require(skew <= allowed, "reduced problem: ", name, " is not symmetric: largest |", name,
           " - ", name, "ᵀ| is ", skew, ", at most ", allowed, " is allowed");
}

/// Where one row alone is a rigid motion, stiffness is round-off, of either sign.
void check_diagonal(const ReducedProblem &problem)
{
   const Eigen::Index m = problem.slips(), rows = problem.K.rows();
   const Eigen::MatrixXd &Z = problem.rigid_motions;
   const double nothing = 1e-10 * problem.K.cwiseAbs().maxCoeff();
   for (Eigen::Index row = 0; row < rows; ++row)
   {
      const bool slip = row < m;
      const Eigen::Index place = slip ? row : row - m;
      const double own = problem.K(row, row);
      require(
         !(Z.rows() == rows && Z.row(row).squaredNorm() > 1 - 1e-10 && own <= nothing),
         "reduced problem: ", slip ? "sliding" : "opening", " at node ",
         place % problem.nodes(),
         " alone is a rigid motion that nothing resists, so no contact can be computed there: "
         "give the contact more nodes (a free body needs three), or support the body");
      require(own > 0, "reduced problem: diagonal of ", slip ? "A" : "C", " is ", own,
              " at row ", place, ", must be positive");
   }
}

void check_vector(const char *name, const Eigen::VectorXd &x, Eigen::Index size)
{
   require(x.size() == size, "reduced problem: ", name, " has ", x.size(), " entries, must be ",
           size);
   for (Eigen::Index i = 0; i < size; ++i)
   {
      require(std::isfinite(x[i]), "reduced problem: ", name, "[", i, "] is ", x[i],
              ", must be finite");
   }
}

/// Does nothing resist the rigid motions?
void check_motions(const ReducedProblem &problem)
{
   const Eigen::MatrixXd &Z = problem.rigid_motions;
   if (Z.cols() == 0) { return; }
   const double resisted =
      product(problem.K, Z).cwiseAbs().maxCoeff() / problem.K.cwiseAbs().maxCoeff();
   require(resisted <= 1e-11, "reduced problem: a rigid motion causes forces of ", resisted,
           " relative to the stiffness, must be below 1e-11");
}

/// Checks of the other data: chains, rigid motions, held components.
void check_facts(const ReducedProblem &problem)
{
   const Eigen::Index n = problem.nodes(), m = problem.slips();
   Eigen::Index next = 0;
   for (const ContactChain &chain : problem.chains)
   {
      require(chain.first == next && chain.nodes > 0, "reduced problem: a chain of ",
              chain.nodes, " nodes begins at node ", chain.first,
              ", chains must follow each other from node 0 (the next is ", next, ")");
      next += chain.nodes;
   }
   for (const ContactChain &chain : problem.chains)
   {
      const auto [own, other] = chain.bodies;
      const auto known = problem.dofs.size() ? problem.dofs.cols() / 2 : own + other + 2;
      require(own >= 0 && other >= -1 && std::max(own, other) < known,
              "reduced problem: a chain of nodes of body ", own, " that faces body ", other,
              ", bodies must be counted from 0, with -1 for a rigid obstacle that is faced");
   }
   require(problem.chains.empty() || next == n, "reduced problem: the chains have ", next,
           " nodes, must have all ", n);
   for (const ContactChain &chain : problem.chains)
   {
      const bool told = problem.arc_length.size() > 0;
      for (Eigen::Index i = chain.first + 1; told && i < chain.first + chain.nodes; ++i)
      {
         require(problem.arc_length[i] > problem.arc_length[i - 1],
                 "reduced problem: arc_length of node ", i, " is ", problem.arc_length[i],
                 ", must be above that of the node before it in its chain, ",
                 problem.arc_length[i - 1]);
      }
   }
   for (Eigen::Index row : problem.held)
   {
      require(std::count(problem.held.begin(), problem.held.end(), row) == 1,
              "reduced problem: row ", row,
              " of A is listed as held twice, must be listed once");
      require(row >= 0 && row < m, "reduced problem: held row ", row,
              " of A, must be from 0 to ", m - 1);
      bool alone = (problem.A().row(row).array() != 0).count() == 1 &&
                   (problem.A().col(row).array() != 0).count() == 1 &&
                   problem.B().col(row).isZero(0);
      for (const LoadPattern &pattern : problem.patterns)
      {
         alone = alone && pattern.q[row] == 0;
      }
      require(alone, "reduced problem: row ", row,
              " of A is listed as held, must be neither coupled nor loaded");
   }
   const Eigen::MatrixXd &Z = problem.rigid_motions;
   require(Z.rows() == m + n, "reduced problem: rigid motions have ", Z.rows(),
           " rows, must have ", m + n,
           " (and no columns if supports hold the bodies; complete() finds them)");
   require(Z.allFinite(), "reduced problem: a rigid motion has an entry that is not finite");
   require(transposed_product(Z, Z).isIdentity(1e-9),
           "reduced problem: the rigid motions must be orthonormal columns");
   check_motions(problem);
}

/// Slopes of the pieces of a polyline from (0, 0).
Eigen::VectorXd slopes(const Eigen::MatrixX2d &points)
{
   const Eigen::Index n = points.rows();
   Eigen::MatrixX2d before = Eigen::MatrixX2d::Zero(n, 2);
   before.bottomRows(n - 1) = points.topRows(n - 1);
   const Eigen::MatrixX2d step = points - before;
   return step.col(1).cwiseQuotient(step.col(0));
}

/// @param where "reduced problem: the law of friction of node 3", for instance
void check_law(const std::string &where, const FrictionLaw &law, Eigen::Index components)
{
   for (const auto &[points, way] :
        {std::pair(&law.forward, "forward"), std::pair(&law.backward, "backward")})
   {
      require(points->rows() > 0 && points->allFinite(), where, " ", way,
              " must have at least one point, and finite points only");
      Eigen::RowVector2d before(0, 0);
      for (const Eigen::RowVector2d &point : points->rowwise())
      {
         require(point[0] > before[0] && point[1] >= before[1], where, " ", way, " goes from ",
                 Eigen::Vector2d(before.transpose()), " to ",
                 Eigen::Vector2d(point.transpose()),
                 ", (pressure, strength): the pressure must increase from 0, and the strength "
                 "must not decrease");
         before = point;
      }
   }
   require(components < 2 ||
              (law.forward.rows() == law.backward.rows() && law.forward == law.backward),
           where,
           " differs between forward and backward slip, must be the same for both with two "
           "tangents, where slip has no sign");
}

void check_laws_of_friction(const ReducedProblem &problem)
{
   const std::vector<FrictionLaw> &laws = problem.laws;
   require(laws.empty() || static_cast<Eigen::Index>(laws.size()) == problem.nodes(),
           "reduced problem: ", laws.size(), " laws of friction for ", problem.nodes(),
           " nodes, must be none, or one for each");
   for (std::size_t i = 0; i < laws.size(); ++i)
   {
      const std::string where =
         "reduced problem: the law of friction of node " + std::to_string(i);
      check_law(where, laws[i], problem.components());
      const double steepest = laws[i].steepest(),
                   said = problem.friction[static_cast<Eigen::Index>(i)];
      require(std::abs(steepest - said) <= 1e-12 * steepest, where, " has the steepest slope ",
              steepest, ", must be equal to `friction` there, ", said,
              ": set_friction_law() sets both, set_friction() removes the laws");
   }
}

} // namespace

double FrictionLaw::steepest() const
{
   return std::max(slopes(forward).maxCoeff(), slopes(backward).maxCoeff());
}

bool FrictionLaw::concave() const
{
   // Where points lie on one line, rounding makes the second piece the steeper one.
   constexpr double round_off = 1e-12;
   const auto falls = [](const Eigen::VectorXd &slope)
   {
      const Eigen::Index pieces = slope.size() - 1;
      return (slope.tail(pieces) - slope.head(pieces)).maxCoeff() <=
             round_off * slope.maxCoeff();
   };
   return (forward.rows() == 1 || falls(slopes(forward))) &&
          (backward.rows() == 1 || falls(slopes(backward)));
}

void ReducedProblem::validate() const
{
   const Eigen::Index n = nodes(), m = slips();
   require(n > 0, "reduced problem: there are no contact nodes");
   require(K.cols() == K.rows() && m >= 0 && m % n == 0, "reduced problem: the stiffness is ",
           K.rows(), "×", K.cols(), ", must have 1, 2 or 3 rows and columns for each of the ",
           n, " nodes");
   require(m <= 2 * n, "reduced problem: ", m / n,
           " tangential components per node, must be 0, 1 or 2");
   require(K.allFinite(), "reduced problem: the stiffness has an entry that is not finite");
   check_symmetric("A", A());
   check_symmetric("C", C());
   check_diagonal(*this);
   require(largest_skew(K.topRightCorner(m, n), B()) == 0,
           "reduced problem: the stiffness is not symmetric: its upper block must be the "
           "transpose of B "
           "(complete() copies it)");
   require(coupled == !B().isZero(0), "reduced problem: `coupled` is ",
           coupled ? "true, but B is" : "false, but B is not",
           " zero (complete() sets `coupled`)");
   std::set<std::string> names;
   for (const LoadPattern &pattern : patterns)
   {
      require(!pattern.name.empty(),
              "reduced problem: a load pattern has an empty name, must have one");
      require(names.insert(pattern.name).second,
              "reduced problem: two load patterns are named '", pattern.name, "'");
      check_vector(("q of pattern '" + pattern.name + "'").c_str(), pattern.q, m);
      check_vector(("p of pattern '" + pattern.name + "'").c_str(), pattern.p, n);
      const LoadSize &size = pattern.size;
      require(size.value > 0 && std::isfinite(size.value),
              "reduced problem: the size of load '", pattern.name, "' is ", size.value,
              ", must be positive and finite");
      require(std::isfinite(size.direction[0]) && std::isfinite(size.direction[1]),
              "reduced problem: the direction of load '", pattern.name, "' must be finite");
   }
   check_vector("gap", gap, n);
   check_vector("friction", friction, n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      require(friction[i] >= 0, "reduced problem: friction coefficient ", friction[i],
              " at node ", i, ", must not be negative");
   }
   check_laws_of_friction(*this);
   const auto size = static_cast<Eigen::Index>(patterns.size());
   require(H.rows() == 0 || (H.rows() == size && H.cols() == size), "reduced problem: H is ",
           H.rows(), "×", H.cols(), ", must have a row and a column for each of the ", size,
           " load patterns, or be empty if it is not known");
   require(H.allFinite(), "reduced problem: H has an entry that is not finite");
   for (Eigen::Index k = 0; k < H.rows(); ++k)
   {
      for (Eigen::Index j = 0; j < k; ++j)
      {
         // Work of one force on the displacement of the other; a force and a displacement
         // meet with opposite signs.
         const double sign = patterns[k].control == patterns[j].control ? 1 : -1;
         const double size = std::max(
            {std::abs(H(k, j)), std::abs(H(j, k)), std::sqrt(std::abs(H(k, k) * H(j, j)))});
         require(std::abs(H(k, j) - sign * H(j, k)) <= 1e-6 * size, "reduced problem: H(", k,
                 ", ", j, ") is ", H(k, j), " and H(", j, ", ", k, ") ", H(j, k), ", must be ",
                 sign > 0 ? "the same" : "opposite", " (Betti)");
      }
   }
   // A problem without a mesh has none of these.
   if (weights.size() > 0) { check_vector("weights", weights, n); }
   for (Eigen::Index i = 0; i < weights.size(); ++i)
   {
      require(weights[i] > 0, "reduced problem: weight ", weights[i], " of node ", i,
              ", must be positive");
   }
   if (arc_length.size() > 0) { check_vector("arc_length", arc_length, n); }
   require(position.size() == 0 ||
              (position.rows() == n && (position.cols() == 2 || position.cols() == 3)),
           "reduced problem: position is ", position.rows(), "×", position.cols(), ", must be ",
           n, "×2 or ", n, "×3");
   require(position.allFinite(), "reduced problem: position has an entry that is not finite");
   const bool in_space = position.cols() == 3;
   require(dofs.size() == 0 || (dofs.rows() == n &&
                                (dofs.cols() % 2 == 0 || (in_space && dofs.cols() % 3 == 0))),
           "reduced problem: dofs is ", dofs.rows(), "×", dofs.cols(), ", must have ", n,
           " rows and two columns for each body", in_space ? ", in space three" : "");
   for (const Eigen::Index node : rim)
   {
      require(node >= 0 && node < n, "reduced problem: node ", node,
              " of the rim, must be from 0 to ", n - 1);
   }
   check_facts(*this);
}

void hold(ReducedProblem &problem, const std::vector<Eigen::Index> &rows)
{
   for (Eigen::Index row : rows)
   {
      require(row >= 0 && row < problem.slips(), "hold: row ", row, " of A, must be from 0 to ",
              problem.slips() - 1);
      if (std::count(problem.held.begin(), problem.held.end(), row)) { continue; }
      const double own = problem.A()(row, row);
      problem.A().row(row).setZero();
      problem.A().col(row).setZero();
      problem.A()(row, row) = own;
      problem.B().col(row).setZero();
      for (LoadPattern &pattern : problem.patterns) { pattern.q[row] = 0; }
      problem.held.push_back(row);
   }
   join_coupling(problem);
   const Eigen::MatrixXd &Z = problem.rigid_motions;
   problem.rigid_motions = at_rest(Z, Z(problem.held, Eigen::all));
}

void complete(ReducedProblem &problem)
{
   join_coupling(problem);
   problem.rigid_motions = null_space(problem.K);
}

void complete(ReducedProblem &problem, const Eigen::MatrixXd &rigid_motions)
{
   join_coupling(problem);
   require(rigid_motions.rows() == problem.K.rows() || rigid_motions.cols() == 0,
           "reduced problem: rigid motions have ", rigid_motions.rows(), " rows, must have ",
           problem.K.rows());
   require(rigid_motions.allFinite(),
           "reduced problem: a rigid motion has an entry that is not finite");
   problem.rigid_motions = Eigen::MatrixXd(problem.K.rows(), 0);
   if (rigid_motions.cols() > 0)
   {
      const Eigen::MatrixXd unit = rigid_motions.colwise().normalized();
      const ThinQR basis = thin_qr(unit);
      constexpr double independent = 1e-10;
      require(basis.R.diagonal().cwiseAbs().minCoeff() > independent &&
                 basis.R.rows() == unit.cols(),
              "reduced problem: the rigid motions must be linearly independent");
      problem.rigid_motions = basis.Q;
   }
   check_motions(problem);
   require_all_motions_stated(problem);
}

void require_all_motions_stated(const ReducedProblem &problem)
{
   if (resists_all_but(problem.K, problem.rigid_motions)) { return; }
   const Eigen::Index stated = problem.rigid_motions.cols(), all = null_space(problem.K).cols();
   require(all <= stated, "reduced problem: it lists ", stated,
           " rigid motions, must list all ", all,
           " that the stiffness does not resist (complete() finds them)");
}

void join_coupling(ReducedProblem &problem)
{
   problem.coupled = !problem.B().isZero(0);
   const Eigen::Index m = problem.slips(), n = problem.nodes();
   if (largest_skew(problem.K.topRightCorner(m, n), problem.B()) == 0) { return; }
   problem.K.topRightCorner(m, n) = problem.B().transpose();
}

void require_semidefinite(const ReducedProblem &problem)
{
   // The allowed asymmetry of K. validate() has the messages about symmetry and diagonals.
   constexpr double round_off = 1e-9;
   if (!(largest_skew(problem.K, problem.K) <= round_off * problem.K.cwiseAbs().maxCoeff()))
   {
      return;
   }
   const Eigen::VectorXd own = problem.K.diagonal(),
                         scale = (own.array() > 0).select(own.cwiseSqrt().cwiseInverse(), 1.0);
   const Eigen::MatrixXd scaled = scale.asDiagonal() * problem.K * scale.asDiagonal();
   Eigen::MatrixXd raised = scaled;
   raised.diagonal().array() += round_off;
   if (DenseCholesky().compute(std::move(raised))) { return; }
   const double lowest = symmetric_eigenvalues(scaled)[0];
   require(lowest >= -round_off, "reduced problem: the stiffness [A Bᵀ; B C] is not positive ",
           "semidefinite, as that of every body is: with a diagonal of ones its smallest ",
           "eigenvalue is ", lowest, ", must be at least ", -round_off,
           "; are signs or the order of rows and columns of A, B or C mixed up?");
}

std::vector<ContactChain> one_chain(Eigen::Index nodes)
{
   ContactChain chain;
   chain.nodes = nodes;
   return {chain};
}

Eigen::MatrixXd rigid_slips(const ReducedProblem &problem)
{
   const Eigen::MatrixXd &Z = problem.rigid_motions;
   return at_rest(Z, Z.bottomRows(problem.nodes())).topRows(problem.slips());
}

Eigen::MatrixXd rigid_openings(const ReducedProblem &problem)
{
   const Eigen::MatrixXd &Z = problem.rigid_motions;
   return at_rest(Z, Z.topRows(problem.slips())).bottomRows(problem.nodes());
}

void set_friction_law(ReducedProblem &problem, const FrictionLaw &law,
                      const std::vector<Eigen::Index> &nodes)
{
   const Eigen::Index n = problem.nodes();
   check_law("law of friction:", law, problem.components());
   require(problem.weights.size() == n,
           "law of friction: the problem has no weights of its nodes, which pressures need");
   std::vector<Eigen::Index> chosen = nodes;
   for (Eigen::Index i = 0; nodes.empty() && i < n; ++i) { chosen.push_back(i); }
   if (problem.laws.empty())
   {
      for (double f : problem.friction)
      {
         const Eigen::RowVector2d coulomb(1, f);
         problem.laws.push_back({coulomb, coulomb});
      }
   }
   for (Eigen::Index i : chosen)
   {
      require(i >= 0 && i < n, "law of friction: node ", i, ", must be from 0 to ", n - 1);
      problem.laws[i] = {problem.weights[i] * law.forward, problem.weights[i] * law.backward};
      problem.friction[i] = problem.laws[i].steepest();
   }
}

void set_friction_law(ReducedProblem &problem, const Eigen::MatrixX2d &points,
                      const std::vector<Eigen::Index> &nodes)
{
   set_friction_law(problem, FrictionLaw{points, points}, nodes);
}

void require_coulomb(const ReducedProblem &problem, const char *who)
{
   require(problem.laws.empty(), who,
           " supports Coulomb's law only, but the reduced problem has another law of friction");
}

void set_friction(ReducedProblem &problem, double coefficient)
{
   require_at_least("friction coefficient", coefficient, 0);
   problem.friction = Eigen::VectorXd::Constant(problem.nodes(), coefficient);
   problem.laws.clear();
}

ReducedProblem absorb_gap(const ReducedProblem &problem)
{
   ReducedProblem result = problem;
   LoadPattern closing{"gap", Control::force, problem.B().transpose() * -problem.gap,
                       problem.C() * -problem.gap};
   result.patterns.push_back(closing);
   const Eigen::Index k = problem.H.rows();
   if (problem.knows_loads())
   {
      result.H = Eigen::MatrixXd::Zero(k + 1, k + 1);
      result.H.topLeftCorner(k, k) = problem.H;
   }
   result.gap.setZero();
   return result;
}

} // namespace cattaneo

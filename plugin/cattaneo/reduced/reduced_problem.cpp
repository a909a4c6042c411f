#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <set>

namespace cattaneo
{

int ReducedProblem::pattern(const std::string &name) const
{
   std::string known;
   for (std::size_t k = 0; k < patterns.size(); ++k)
   {
      if (patterns[k].name == name) { return static_cast<int>(k); }
      known += (k ? ", " : "") + patterns[k].name;
   }
   throw InputError("reduced problem: no load pattern '" + name + "'; there are: " + known);
}

Eigen::VectorXd ReducedProblem::clamped_forces(const Eigen::VectorXd &multipliers) const
{
   require(multipliers.size() == static_cast<Eigen::Index>(patterns.size()),
           "reduced problem: ", multipliers.size(), " load multipliers for ", patterns.size(),
           " load patterns");
   const Eigen::Index m = A.rows();
   Eigen::VectorXd f = Eigen::VectorXd::Zero(m + nodes());
   for (std::size_t k = 0; k < patterns.size(); ++k)
   {
      f.head(m) += multipliers[k] * patterns[k].q;
      f.tail(nodes()) += multipliers[k] * patterns[k].p;
   }
   return f;
}

Eigen::MatrixXd ReducedProblem::stiffness() const
{
   const Eigen::Index m = A.rows(), n = nodes();
   Eigen::MatrixXd K(m + n, m + n);
   K.topLeftCorner(m, m) = A;
   K.topRightCorner(m, n) = B.transpose();
   K.bottomLeftCorner(n, m) = B;
   K.bottomRightCorner(n, n) = C;
   return K;
}

namespace
{

void check_symmetric(const char *name, const Eigen::MatrixXd &M)
{
   require(M.allFinite(), "reduced problem: ", name, " has an entry that is not finite");
   if (M.size() == 0) { return; }
   const double scale = M.cwiseAbs().maxCoeff();
   const double skew = (M - M.transpose()).cwiseAbs().maxCoeff();
   require(skew <= 1e-9 * scale, "reduced problem: ", name, " is not symmetric: largest |",
           name, " - ", name, "ᵀ| is ", skew, ", at most ", 1e-9 * scale, " is allowed");
   Eigen::Index i = 0;
   const double smallest = M.diagonal().minCoeff(&i);
   require(smallest > 0, "reduced problem: diagonal of ", name, " is ", smallest, " at row ", i,
           ", must be positive");
}

void check_vector(const char *name, const Eigen::VectorXd &x, Eigen::Index size)
{
   require(x.size() == size, "reduced problem: ", name, " has ", x.size(), " entries, must be ",
           size);
   require(x.allFinite(), "reduced problem: ", name, " has an entry that is not finite");
}

} // namespace

void ReducedProblem::validate() const
{
   const Eigen::Index n = nodes(), m = A.rows();
   require(n > 0, "reduced problem: there are no contact nodes");
   require(C.cols() == n && A.cols() == m && B.rows() == n && B.cols() == m && m % n == 0,
           "reduced problem: sizes of A (", A.rows(), "×", A.cols(), "), B (", B.rows(), "×",
           B.cols(), ") and C (", C.rows(), "×", C.cols(), ") do not fit");
   require(m <= 2 * n, "reduced problem: ", m / n,
           " tangential components a node, must be 0, 1 or 2");
   check_symmetric("A", A);
   check_symmetric("C", C);
   require(B.allFinite(), "reduced problem: B has an entry that is not finite");
   std::set<std::string> names;
   for (const LoadPattern &pattern : patterns)
   {
      require(names.insert(pattern.name).second,
              "reduced problem: two load patterns are named '", pattern.name, "'");
      check_vector(("q of pattern '" + pattern.name + "'").c_str(), pattern.q, m);
      check_vector(("p of pattern '" + pattern.name + "'").c_str(), pattern.p, n);
   }
   check_vector("gap", gap, n);
   check_vector("friction", friction, n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      require(friction[i] >= 0, "reduced problem: friction coefficient ", friction[i],
              " at node ", i, " is negative");
   }
   const auto size = static_cast<Eigen::Index>(patterns.size());
   require(H.rows() == size && H.cols() == size, "reduced problem: H is ", H.rows(), "×",
           H.cols(), ", must be square of the number of load patterns ", size);
   require(H.allFinite(), "reduced problem: H has an entry that is not finite");
   // A problem without a mesh has none of these.
   if (weights.size() > 0) { check_vector("weights", weights, n); }
   if (arc_length.size() > 0) { check_vector("arc_length", arc_length, n); }
   require(position.size() == 0 || (position.rows() == n && position.cols() == 2),
           "reduced problem: position is ", position.rows(), "×", position.cols(), ", must be ",
           n, "×2");
   require(position.allFinite(), "reduced problem: position has an entry that is not finite");
   require(dofs.size() == 0 || (dofs.rows() == n && dofs.cols() % 2 == 0),
           "reduced problem: dofs is ", dofs.rows(), "×", dofs.cols(), ", must have ", n,
           " rows and two columns for each body");
}

void set_friction(ReducedProblem &problem, double coefficient)
{
   require(coefficient >= 0, "friction coefficient is ", coefficient, ", must not be negative");
   problem.friction = Eigen::VectorXd::Constant(problem.nodes(), coefficient);
}

ReducedProblem absorb_gap(const ReducedProblem &problem)
{
   ReducedProblem result = problem;
   LoadPattern closing{"gap", Control::force, problem.B.transpose() * -problem.gap,
                       problem.C * -problem.gap};
   result.patterns.push_back(closing);
   const Eigen::Index k = problem.H.rows();
   result.H = Eigen::MatrixXd::Zero(k + 1, k + 1);
   result.H.topLeftCorner(k, k) = problem.H;
   result.gap.setZero();
   return result;
}

} // namespace cattaneo

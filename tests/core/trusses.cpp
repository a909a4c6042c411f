#include "trusses.hpp"

#include "comparison.hpp"
#include "line_along.hpp"

#include <algorithm>
#include <cattaneo/reduced/mortar.hpp>

namespace cattaneo_test
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

std::mt19937 random_numbers(7);

double random_number(double low, double high)
{
   return std::uniform_real_distribution<double>(low, high)(random_numbers);
}

Truss::Truss(std::vector<ContactLine> sides, const Vector2d &around, double stiffness)
   : lines(std::move(sides))
{
   for (ContactLine &line : lines)
   {
      for (LineNode &node : line.nodes)
      {
         std::size_t p = 0;
         while (p < points.size() && (points[p] - node.position).norm() > 1e-9) { ++p; }
         if (p == points.size()) { points.push_back(node.position); }
         node.dofs = {2 * static_cast<int>(p), 2 * static_cast<int>(p) + 1};
      }
   }
   for (int k = 0; k < 5; ++k)
   {
      points.push_back(around + Vector2d(random_number(-0.3, 0.3), random_number(-0.3, 0.3)));
   }
   const auto count = static_cast<int>(points.size());
   K = MatrixXd::Zero(2 * count, 2 * count);
   for (int p = 0; p < count; ++p)
   {
      for (int q = p + 1; q < count; ++q)
      {
         const Vector2d along = points[q] - points[p];
         const Eigen::Vector4d stretch =
            (Eigen::Vector4d() << -along, along).finished() / along.norm();
         const std::vector<int> dofs{2 * p, 2 * p + 1, 2 * q, 2 * q + 1};
         K(dofs, dofs) +=
            stiffness * random_number(0.5, 2) / along.norm() * stretch * stretch.transpose();
      }
   }
}

Truss &Truss::hold()
{
   for (int k = 4; k > 0; --k) { fixed.push_back(size() - k); }
   return *this;
}

Truss &Truss::load(const std::string &name)
{
   loads.push_back({name, Control::force, VectorXd(size())});
   for (double &force : loads.back().values) { force = random_number(); }
   for (int dof : fixed) { loads.back().values[dof] = 0; }
   return *this;
}

Truss &Truss::lift(const std::string &name)
{
   loads.push_back({name, Control::displacement, VectorXd::Zero(size())});
   for (int dof : fixed) { loads.back().values[dof] = random_number(-0.1, 0.1); }
   return *this;
}

CondensedBody Truss::condensed(const std::string &name, const CondensedBody *alike) const
{
   AssembledBody body;
   body.K = SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(K.sparseView()));
   body.places = {VectorXd(size()), VectorXd(size()), {}, Formulation::plane};
   for (int dof = 0; dof < size(); ++dof)
   {
      body.places.x[dof] = points[dof / 2][0];
      body.places.y[dof] = points[dof / 2][1];
      body.places.component.push_back(dof % 2);
   }
   body.fixed = fixed;
   body.loads = loads;
   CondensedBody made = condense(body, joined(lines), alike);
   made.name = name;
   return made;
}

std::vector<int> at_places(const ContactLine &line, const std::vector<Vector2d> &places)
{
   std::vector<int> nodes;
   for (Index k = 0; k < line.size(); ++k)
   {
      for (const Vector2d &x : places)
      {
         if ((line.nodes[k].position - x).norm() < 1e-12) { nodes.push_back(int(k)); }
      }
   }
   return nodes;
}

namespace
{

/// Contact nodes know the dofs of their slave's nodes, and of no other body unless lines match.
void expect_dofs_of_nodes(const Reduction &reduction, const std::vector<Interface> &interfaces,
                          std::size_t bodies)
{
   const ReducedProblem &problem = reduction.problem;
   ASSERT_EQ(problem.dofs.cols(), Index(2 * bodies));
   for (std::size_t k = 0; k < interfaces.size(); ++k)
   {
      const InterfaceReport &report = reduction.interfaces[k];
      if (report.matching) { continue; }
      const InterfaceSide &slave =
         interfaces[k].slave == SlaveSide::first ? interfaces[k].first : interfaces[k].second;
      for (Index i = report.first; i < report.first + report.nodes; ++i)
      {
         const std::vector<int> at = at_places(slave.line, {problem.position.row(i)});
         ASSERT_EQ(at.size(), 1u);
         Eigen::RowVectorXi expected = Eigen::RowVectorXi::Constant(problem.dofs.cols(), -1);
         expected[2 * slave.body] = slave.line.nodes[at[0]].dofs[0];
         expected[2 * slave.body + 1] = slave.line.nodes[at[0]].dofs[1];
         EXPECT_EQ(problem.dofs.row(i), expected);
      }
   }
}

} // namespace

void agrees_with_multipliers(const std::vector<Truss> &bodies, Reduction &reduction,
                             const std::vector<Interface> &interfaces, double tolerance)
{
   const ReducedProblem &problem = reduction.problem;
   problem.validate();
   const Index n = problem.nodes();
   std::vector<Index> offset{0};
   for (const Truss &body : bodies) { offset.push_back(offset.back() + body.size()); }
   const Index size = offset.back();
   MatrixXd G = MatrixXd::Zero(2 * n, size);
   Index row = 0;
   for (std::size_t k = 0; k < interfaces.size(); ++k)
   {
      const InterfaceReport &report = reduction.interfaces[k];
      ASSERT_EQ(report.first, row);
      const bool first = interfaces[k].slave == SlaveSide::first;
      const InterfaceSide &slave = first ? interfaces[k].first : interfaces[k].second,
                          &master = first ? interfaces[k].second : interfaces[k].first;
      const ContactLine &line = slave.line;
      if (master.body < 0)
      {
         for (const LineNode &node : line.nodes)
         {
            for (int c : {0, 1})
            {
               const Index column = offset[slave.body] + node.dofs[c];
               G(row, column) = node.tangent[c];
               G(n + row, column) = node.normal()[c];
            }
            ++row;
         }
         continue;
      }
      const Mortar found = mortar(line, master.line, at_places(line, report.without_row));
      ASSERT_EQ(report.nodes, Index(found.nodes.size()));
      for (Index i = 0; i < report.nodes; ++i, ++row)
      {
         const Vector2d t = found.tangent.row(i), normal(-t[1], t[0]);
         const auto add =
            [&](const InterfaceSide &side, const std::array<Mortar::Matrix, 2> &of, double sign)
         {
            for (int c : {0, 1})
            {
               for (Index j = 0; j < side.line.size(); ++j)
               {
                  const double share = sign * of[c].coeff(i, j);
                  const Index column = offset[side.body] + side.line.nodes[j].dofs[c];
                  G(row, column) += t[c] * share;
                  G(n + row, column) += normal[c] * share;
               }
            }
         };
         add(slave, found.own, 1);
         add(master, found.other, -1);
      }
   }
   ASSERT_EQ(row, n);
   expect_dofs_of_nodes(reduction, interfaces, bodies.size());
   for (Index held : problem.held) { G.row(held).setZero(); }
   const auto patterns = static_cast<Index>(problem.patterns.size());
   MatrixXd K = MatrixXd::Zero(size, size), F = MatrixXd::Zero(size, patterns),
            given = MatrixXd::Zero(size, patterns);
   std::vector<Index> rest;
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const Truss &body = bodies[b];
      K.block(offset[b], offset[b], body.size(), body.size()) = body.K;
      for (const BodyLoad &load : body.loads)
      {
         auto &values = load.control == Control::force ? F : given;
         values.block(offset[b], problem.pattern(load.name), body.size(), 1) += load.values;
      }
      for (int dof = 0; dof < body.size(); ++dof)
      {
         if (!std::count(body.fixed.begin(), body.fixed.end(), dof))
         {
            rest.push_back(offset[b] + dof);
         }
      }
   }
   const auto m = static_cast<Index>(rest.size());
   MatrixXd system = MatrixXd::Zero(m + 2 * n, m + 2 * n);
   const double unit = K.diagonal().mean();
   system << K(rest, rest), unit * G(Eigen::all, rest).transpose(), unit * G(Eigen::all, rest),
      MatrixXd::Zero(2 * n, 2 * n);
   const Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver(system);
   // Unit displacements, then unit multipliers.
   MatrixXd rhs = MatrixXd::Zero(m + 2 * n, 2 * n + patterns),
            u = MatrixXd::Zero(2 * n, rhs.cols());
   u.leftCols(2 * n).setIdentity();
   rhs.bottomLeftCorner(2 * n, 2 * n) = unit * MatrixXd::Identity(2 * n, 2 * n);
   for (Index held : problem.held) { rhs.row(m + held).setZero(); }
   rhs.topRightCorner(m, patterns) = F(rest, Eigen::all) - (K * given)(rest, Eigen::all);
   rhs.bottomRightCorner(2 * n, patterns) = -unit * G * given;
   const MatrixXd x = solver.solve(rhs);
   EXPECT_LT((system * x - rhs).cwiseAbs().maxCoeff(), 1e-9 * unit); // independent rows
   // K U - F = Gᵀ f
   MatrixXd f = -unit * x.bottomRows(2 * n);
   // What does not slide has any stiffness.
   for (Index held : problem.held) { f(held, held) = problem.K(held, held); }
   EXPECT_LT(difference(problem.K, f.leftCols(2 * n)), tolerance);
   for (Index k = 0; k < patterns; ++k)
   {
      VectorXd own(2 * n);
      own << problem.patterns[k].q, problem.patterns[k].p;
      EXPECT_LT(difference(own, f.col(2 * n + k)), tolerance) << problem.patterns[k].name;
   }
   // Fields and conjugates of something at random.
   VectorXd z(2 * n + patterns);
   for (double &value : z) { value = random_number(); }
   MatrixXd U = MatrixXd::Zero(size, 1);
   U(rest, Eigen::all) = x.topRows(m) * z;
   U += given * z.tail(patterns);
   // A motion that all bodies have in common is nobody's.
   const auto held = static_cast<Index>(problem.held.size());
   const bool moves = system.cols() - held > solver.rank();
   VectorXd strained = K * U.col(0);
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const VectorXd field = reduction.displacement(static_cast<int>(b), z.head(n),
                                                    z.segment(n, n), z.tail(patterns));
      if (!moves)
      {
         EXPECT_LT(difference(field, U.middleRows(offset[b], bodies[b].size())), tolerance);
      }
      EXPECT_LT(difference(bodies[b].K * field, strained.segment(offset[b], bodies[b].size())),
                10 * tolerance);
   }
   // Forces that are in balance do no work on a common motion.
   for (Index k = 0; k < patterns; ++k)
   {
      const LoadPattern &pattern = problem.patterns[k];
      const double work = pattern.q.dot(z.head(n)) + pattern.p.dot(z.segment(n, n));
      const VectorXd forces = K * U.col(0) - F * z.tail(patterns);
      const bool force = pattern.control == Control::force;
      const double direct = force ? F.col(k).dot(U.col(0)) : given.col(k).dot(forces);
      const double response = problem.H.row(k).dot(z.tail(patterns));
      EXPECT_NEAR(response + (force ? -work : work), direct, 1e-8 * (1 + std::abs(direct)))
         << pattern.name;
   }
}

Interface between(int a, const ContactLine &one, int b, const ContactLine &two, SlaveSide slave)
{
   return {"face", {a, one}, {b, two}, slave, std::nullopt, 1.0};
}

ContactLine side(const Vector2d &from, const Vector2d &to, int elements, int order)
{
   return line_along(straight(from, to), uniform_grid(0, 1, elements), order);
}

} // namespace cattaneo_test

#include "shakedown_problems.hpp"

namespace shakedown_test
{

Eigen::MatrixXd random_matrix(std::mt19937 &random, Eigen::Index rows, Eigen::Index cols)
{
   std::uniform_real_distribution<double> uniform(-1, 1);
   return Eigen::MatrixXd::NullaryExpr(rows, cols, [&]() { return uniform(random); });
}

ReducedProblem random_contact(unsigned seed, Eigen::Index n, Eigen::Index c, bool rigid)
{
   std::mt19937 random(seed);
   const Eigen::Index m = c * n;
   const Eigen::MatrixXd G = random_matrix(random, m + n, m + n);
   Eigen::MatrixXd K = G * G.transpose() / static_cast<double>(n);
   K.diagonal().array() += 1;
   if (rigid)
   {
      Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(m + n, c + (n > 2 ? 2 : 1));
      for (Eigen::Index k = 0; k <= c; ++k) { modes.block(k * n, k, n, 1).setOnes(); }
      if (n > 2) { modes.block(m, c + 1, n, 1) = Eigen::VectorXd::LinSpaced(n, -1, 1); }
      const Eigen::MatrixXd basis =
         Eigen::HouseholderQR<Eigen::MatrixXd>(modes).householderQ() *
         Eigen::MatrixXd::Identity(m + n, modes.cols());
      const Eigen::MatrixXd keep =
         Eigen::MatrixXd::Identity(m + n, m + n) - basis * basis.transpose();
      K = keep * K * keep;
      K = (0.5 * (K + K.transpose())).eval();
   }
   ReducedProblem problem;
   problem.set_stiffness(K.topLeftCorner(m, m), K.bottomLeftCorner(n, m),
                         K.bottomRightCorner(n, n));
   const auto vector = [&](Eigen::Index size)
   { return Eigen::VectorXd(random_matrix(random, size, 1)); };
   const Eigen::VectorXd pressure = vector(n).array() * 0.3 + 1;
   problem.patterns = {
      {"press", Control::force, 0.1 * vector(m), pressure},
      {"shear", Control::force, vector(m).array() * 0.4 + 0.6, 0.3 * vector(n)},
      {"twist", Control::force, 0.5 * vector(m), 0.3 * vector(n)}};
   problem.H = Eigen::MatrixXd::Zero(3, 3);
   problem.chains = one_chain(n);
   problem.gap = Eigen::VectorXd::Zero(n);
   problem.friction = vector(n).array() * 0.2 + 0.5;
   return problem;
}

ReducedProblem punch_like(Eigen::Index n, double coupling)
{
   Eigen::VectorXd x(n), weights(n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      x[i] = -std::cos(M_PI * static_cast<double>(i) / static_cast<double>(n - 1));
   }
   for (Eigen::Index i = 0; i < n; ++i)
   {
      weights[i] = 0.5 * (x[std::min(i + 1, n - 1)] - x[std::max<Eigen::Index>(i - 1, 0)]);
   }
   ReducedProblem problem;
   Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n), B = A;
   for (Eigen::Index i = 0; i < n; ++i)
   {
      for (Eigen::Index j = 0; j < n; ++j)
      {
         if (i == j) { continue; }
         const double spring = weights[i] * weights[j] / (M_PI * (x[i] - x[j]) * (x[i] - x[j]));
         A(i, i) += spring;
         A(i, j) -= spring;
      }
   }
   for (Eigen::Index e = 0; e + 1 < n; ++e)
   {
      B.block(e, e, 2, 2) += 0.5 * coupling * Eigen::Matrix2d{{-1, 1}, {-1, 1}};
   }
   const Eigen::MatrixXd resultant = weights * Eigen::RowVectorXd::Ones(n) / weights.sum();
   B -= (resultant * B).eval();
   problem.set_stiffness(A, B, A);
   problem.weights = weights;
   problem.chains = one_chain(n);
   problem.arc_length = x;
   const Eigen::ArrayXd s = x.array(), bell = (1 - s.square()).square();
   const Eigen::ArrayXd h = weights.array();
   problem.patterns = {{"P", Control::force, 0.1 * h * s, 0.5 * h * (1 + 0.3 * s.square())},
                       {"Q", Control::force, 0.5 * h * (0.7 + bell + 0.1 * s), -0.3 * h * s}};
   problem.H = Eigen::MatrixXd::Zero(2, 2);
   problem.gap = Eigen::VectorXd::Zero(n);
   set_friction(problem, 0.85);
   return problem;
}

LoadCycle random_cycle(unsigned seed, Eigen::Index patterns, Eigen::Index vertices)
{
   std::mt19937 random(seed + 1000);
   LoadCycle cycle{Eigen::VectorXd::Zero(patterns), random_matrix(random, patterns, vertices)};
   cycle.constant[0] = 1;
   cycle.varying.row(0) *= 0.3;
   return cycle;
}

RandomLimit random_limit(unsigned seed, Eigen::Index components)
{
   std::mt19937 random(seed);
   std::uniform_real_distribution<double> uniform(-1, 1);
   const auto chance = [&](double share) { return 0.5 * (uniform(random) + 1) < share; };
   const auto power = [&](double low, double high)
   { return std::pow(10, low + (high - low) * 0.5 * (uniform(random) + 1)); };
   const Eigen::Index c = components;
   const auto n = static_cast<Eigen::Index>(1 + random() % (c == 1 ? 8 : 5)), m = c * n;
   const auto vector = [&](Eigen::Index size)
   { return Eigen::VectorXd(random_matrix(random, size, 1)); };

   // Random eigenvectors couple strongly; a share of B leaves the stiffness definite.
   ReducedProblem problem = random_contact(random(), n, c, n > 1 && chance(0.4));
   const Eigen::MatrixXd stronger = random_matrix(random, m + n, 1 + n);
   if (n == 1 || chance(0.3))
   {
      const Eigen::MatrixXd K =
         problem.K / problem.K.norm() + power(-2, 2) * stronger * stronger.transpose();
      problem.set_stiffness(K.topLeftCorner(m, m), K.bottomLeftCorner(n, m),
                            K.bottomRightCorner(n, n));
   }
   if (chance(0.3))
   {
      problem.set_stiffness(problem.A(), (chance(0.5) ? 0.0 : power(-3, 0)) * problem.B(),
                            problem.C());
   }

   Eigen::VectorXd &pressure = problem.patterns[0].p, &shear = problem.patterns[0].q;
   if (chance(0.3)) { pressure += power(-1, 0.5) * vector(n); }
   if (chance(0.1)) { pressure.setZero(); }
   shear = vector(m) * (chance(0.2) ? 0.0 : power(-2, 0.7));
   if (chance(0.3)) { problem.patterns[1].p.setZero(); }
   if (chance(0.2)) { problem.patterns[1].p = pressure.cwiseAbs(); }
   if (chance(0.05)) { problem.patterns[1].q.setZero(); }
   problem.friction.setConstant(power(-1.3, 0.7));
   if (chance(0.5)) { problem.friction.array() *= 1 + 0.5 * vector(n).array(); }

   LoadCycle cycle{Eigen::Vector3d(1, 0, 0), Eigen::MatrixXd::Zero(3, 2)};
   if (chance(0.6))
   {
      const double reversals[] = {-1, -0.5, 0, 1, uniform(random)};
      cycle.varying.row(1) << 1, reversals[random() % 5];
   }
   else
   {
      cycle.varying = random_matrix(random, 3, static_cast<Eigen::Index>(1 + random() % 5));
      if (chance(0.5)) { cycle.varying.row(0).setZero(); }
   }
   const double force = power(-6, 6), length = power(-6, 6);
   problem.K *= force / length;
   for (LoadPattern &pattern : problem.patterns)
   {
      pattern.q *= force;
      pattern.p *= force;
   }
   cycle.varying *= power(-3, 3);
   return {std::move(problem), std::move(cycle)};
}

double brute_force_load(const ReducedProblem &problem, const LoadCycle &cycle)
{
   const Eigen::Index n = problem.nodes();
   const bool rigid = (problem.A() * Eigen::VectorXd::Ones(n)).norm() < 1e-10;
   const Eigen::Index first = rigid ? 1 : 0, unknowns = 1 + n - first;
   const Eigen::VectorXd constant = problem.clamped_forces(cycle.constant);
   const Eigen::Index rows = 2 * n * cycle.vertices();
   Eigen::MatrixXd G(rows, unknowns); // G x + h >= 0
   Eigen::VectorXd h(rows);
   Eigen::Index row = 0;
   for (Eigen::Index j = 0; j < cycle.vertices(); ++j)
   {
      const Eigen::VectorXd varying = problem.clamped_forces(cycle.varying.col(j));
      for (Eigen::Index i = 0; i < n; ++i)
      {
         for (const double sign : {1.0, -1.0})
         {
            const double f = problem.friction[i];
            const Eigen::RowVectorXd slip = f * problem.B().row(i) + sign * problem.A().row(i);
            G(row, 0) = f * varying[n + i] + sign * varying[i];
            G.row(row).tail(unknowns - 1) = slip.tail(n - first);
            h[row++] = f * constant[n + i] + sign * constant[i];
         }
      }
   }
   double best = -std::numeric_limits<double>::infinity();
   std::vector<bool> chosen(rows, false);
   std::fill(chosen.begin(), chosen.begin() + unknowns, true);
   do {
      Eigen::MatrixXd equations(unknowns, unknowns);
      Eigen::VectorXd right(unknowns);
      Eigen::Index k = 0;
      for (Eigen::Index r = 0; r < rows; ++r)
      {
         if (!chosen[r]) { continue; }
         equations.row(k) = G.row(r);
         right[k++] = -h[r];
      }
      const Eigen::FullPivLU<Eigen::MatrixXd> lu(equations);
      if (!lu.isInvertible()) { continue; }
      const Eigen::VectorXd corner = lu.solve(right);
      if ((G * corner + h).minCoeff() > -1e-10) { best = std::max(best, corner[0]); }
   } while (std::prev_permutation(chosen.begin(), chosen.end()));
   return best;
}

} // namespace shakedown_test

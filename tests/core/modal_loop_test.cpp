#include "half_space_contacts.hpp"

#include <array>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/joints/modal_loop.hpp>
#include <cmath>
#include <gtest/gtest.h>

using namespace cattaneo;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

const double pi = std::acos(-1.0);

/// A mass m on a spring to the ground and on Jenkins elements, each a spring k in line with a
/// slider that holds up to s.
struct MassOnSliders
{
   double m = 2.5, ground = 1.2;
   VectorXd k{{1.0, 2.0, 0.5}}, s{{0.4, 0.3, 0.6}};

   double stiffness() const { return ground + k.sum(); }
   double omega() const { return std::sqrt(stiffness() / m); }

   /** With x = (sqrt(m) α + kᵀ v) / K and the forces k (v - x) on the sliders, which P presses
       so that they hold s with a friction of 1/2. The amplitude is sqrt(m) x. */
   ReducedProblem problem() const
   {
      const double K = stiffness(), f = 0.5;
      const Eigen::Index n = k.size();
      ReducedProblem made;
      made.set_stiffness(MatrixXd(k.asDiagonal()) - k * k.transpose() / K, MatrixXd::Zero(n, n),
                         MatrixXd::Identity(n, n));
      made.patterns = {{"P", Control::force, VectorXd::Zero(n), s / f},
                       {"mode 1", Control::force, -std::sqrt(m) / K * k, VectorXd::Zero(n)}};
      made.H = MatrixXd::Zero(2, 2);
      made.H(1, 1) = m / K;
      set_friction(made, f);
      return made;
   }
   ContactState pressed(const ReducedProblem &made) const
   {
      ContactState state = ContactState::virgin(made);
      march(made, LoadHistory::through(made, {{}, {{"P", 1}}}), state);
      return state;
   }
   ModalLoop loop(double size, const ModalLoopSettings &settings = {}) const
   {
      const ReducedProblem made = problem();
      FrictionSolver solver(made);
      return modal_loop(solver, made, pressed(made), "mode 1", omega(), size, settings);
   }

   // By hand, for a displacement x that swings by X.
   double force(double X) const { return ground * X + (k * X).cwiseMin(s).sum(); }
   double lost(int i, double X) const { return std::max(0.0, 4 * s[i] * (X - s[i] / k[i])); }
   /// In phase with X cos θ.
   double harmonic(double X) const
   {
      double sum = ground * X;
      for (int i = 0; i < k.size(); ++i)
      {
         const double reached = s[i] / (k[i] * X);
         const double until = reached >= 1 ? pi : std::acos(1 - 2 * reached);
         sum += k[i] * X / pi * (until - 0.5 * std::sin(2 * until));
      }
      return sum;
   }
};

} // namespace

TEST(ModalLoop, JenkinsElementsByHand)
{
   const MassOnSliders sliders;
   // None, one, two and all three slip.
   for (const double X : {0.1, 0.3, 0.9, 2.0})
   {
      SCOPED_TRACE(X);
      const ModalLoop loop = sliders.loop(std::sqrt(sliders.m) * X);
      ASSERT_EQ(loop.status, FrictionStatus::converged) << loop.message;
      EXPECT_TRUE(loop.steady);
      EXPECT_GE(loop.cycle, 1);
      EXPECT_NEAR(loop.amplitude / std::sqrt(sliders.m), X, 1e-8 * X);
      EXPECT_NEAR(loop.omega_secant, std::sqrt(sliders.force(X) / (sliders.m * X)), 1e-8);
      EXPECT_NEAR(loop.omega, std::sqrt(sliders.harmonic(X) / (sliders.m * X)), 1e-8);
      double lost = 0;
      for (int i = 0; i < 3; ++i)
      {
         EXPECT_NEAR(loop.node_dissipation[i], sliders.lost(i, X), 1e-7);
         lost += sliders.lost(i, X);
      }
      EXPECT_NEAR(loop.dissipation, lost, 1e-7);
      EXPECT_NEAR(loop.area, loop.dissipation, 1e-9 * (1 + lost));
      EXPECT_NEAR(loop.zeta_secant, lost / (2 * pi * sliders.force(X) * X), 1e-8);
      EXPECT_NEAR(loop.zeta, lost / (2 * pi * sliders.harmonic(X) * X), 1e-8);
      // These loops begin at rest, and Jenkins elements obey Masing's rule.
      EXPECT_NEAR(loop.omega_first, loop.omega_secant, 1e-8);
      EXPECT_NEAR(loop.zeta_masing, loop.zeta_secant, 1e-8);
   }
}

/// So many elements that they are Iwan's: limits spread evenly from 0 to the largest.
TEST(ModalLoop, IwansModel)
{
   MassOnSliders many;
   const int n = 200;
   const double whole = 3, yield = 1; // stiffness, and displacement at which all slip
   many.k = VectorXd::Constant(n, whole / n);
   many.s = whole / n * yield * (VectorXd::LinSpaced(n, 0.5, n - 0.5) / n);
   const double X = 0.4;
   const ModalLoop loop = many.loop(std::sqrt(many.m) * X);
   ASSERT_EQ(loop.status, FrictionStatus::converged) << loop.message;
   // F = ground X + ∫ min(k X, k d) dd/yield, D = ∫ 4 k d (X - d) dd/yield.
   const double force = many.ground * X + whole * (X - X * X / (2 * yield)),
                lost = 4 * whole * X * X * X / (6 * yield);
   EXPECT_NEAR(loop.force * std::sqrt(many.m), force, 1e-4 * force);
   EXPECT_NEAR(loop.dissipation, lost, 1e-4 * lost);
}

TEST(ModalLoop, SizeByEnergy)
{
   const MassOnSliders sliders;
   ModalLoopSettings settings;
   settings.size = LoopSize::energy;
   const double X = 0.5;
   const ModalLoop loop = sliders.loop(0.5 * sliders.force(X) * X, settings);
   ASSERT_EQ(loop.status, FrictionStatus::converged) << loop.message;
   EXPECT_NEAR(loop.amplitude / std::sqrt(sliders.m), X, 1e-7);
}

/// Without the spring to the ground nothing holds the mass beyond the sum of all limits.
TEST(ModalLoop, SlidesAsAWhole)
{
   MassOnSliders sliders;
   sliders.ground = 0;
   const ModalLoop held = sliders.loop(std::sqrt(sliders.m) * 0.35);
   EXPECT_EQ(held.status, FrictionStatus::converged) << held.message;
   const ModalLoop loop = sliders.loop(std::sqrt(sliders.m) * 5);
   EXPECT_EQ(loop.status, FrictionStatus::gross_sliding);
   EXPECT_NEAR(loop.sliding_force, sliders.s.sum() / std::sqrt(sliders.m), 1e-8);
   EXPECT_FALSE(loop.message.empty());
   // The largest that there is: all limits are reached at 0.6 / 0.5.
   EXPECT_NEAR(loop.amplitude / std::sqrt(sliders.m), 1.2, 1e-5);
}

TEST(ModalLoop, RefusesWhatIsNoSize)
{
   const MassOnSliders sliders;
   EXPECT_THROW(sliders.loop(0), InputError);
   EXPECT_THROW(sliders.loop(-1), InputError);
   ModalLoopSettings settings;
   settings.cycles = 1;
   EXPECT_THROW(sliders.loop(1, settings), InputError);
}

namespace
{

/** An inchworm: two nodes on the ground, between them a spring of stiffness 1, and from each a
    spring to the ground. The load α pushes them apart by α and presses the first by 1 + α/3 and
    the second by 1 - α/3. In one direction the second node moves on, in the other the first one
    follows. */
struct Inchworm
{
   double f = 0.5, A = 0.6;
   ReducedProblem problem;
   ContactState state;

   explicit Inchworm(double ground)
   {
      problem.set_stiffness(MatrixXd{{1 + ground, -1}, {-1, 1 + ground}}, MatrixXd::Zero(2, 2),
                            MatrixXd::Identity(2, 2));
      problem.patterns = {
         {"P", Control::force, VectorXd::Zero(2), VectorXd::Ones(2)},
         {"mode 1", Control::force, VectorXd{{1, -1}}, VectorXd{{1.0 / 3, -1.0 / 3}}}};
      problem.H = MatrixXd{{0, 0}, {0, 1}};
      set_friction(problem, f);
      state = ContactState::virgin(problem);
      march(problem, LoadHistory::through(problem, {{}, {{"P", 1}}}), state);
   }
   /// Of the force A, whatever its size.
   ModalLoop loop(int cycles = 200) const
   {
      FrictionSolver solver(problem);
      ModalLoopSettings settings;
      settings.tolerance = 1e3;
      settings.cycles = cycles;
      return modal_loop(solver, problem, state, "mode 1", 1, A, settings);
   }
};

} // namespace

/// Without springs to the ground it moves on by 2 (A - f (1 - A/3)) in a cycle between A and
/// -A.
TEST(ModalLoop, RatchetsAreNoSteadyLoops)
{
   const Inchworm worm(0);
   const ModalLoop loop = worm.loop();
   EXPECT_FALSE(loop.steady);
   EXPECT_NEAR(loop.ratchet, 2 * (worm.A - worm.f * (1 - worm.A / 3)), 1e-9);
   EXPECT_LT(loop.cycle, 10);
   EXPECT_NE(loop.message.find("ratchets"), std::string::npos) << loop.message;
}

/// Springs to the ground stop it, with slips that fall in a ratio. The loop is the one to which
/// a march of many cycles comes.
TEST(ModalLoop, IsTheLoopToWhichCyclesCome)
{
   const Inchworm worm(0.02);
   const ModalLoop loop = worm.loop();
   ASSERT_TRUE(loop.steady) << loop.message;
   EXPECT_EQ(loop.force, worm.A);
   EXPECT_GT(loop.dissipation, 0.1);
   EXPECT_NEAR(loop.area, loop.dissipation, 1e-9 * loop.dissipation);
   EXPECT_LT(loop.cycle, 20);

   LoadHistory history;
   history.times = VectorXd::LinSpaced(4, 0, 3);
   history.multipliers = MatrixXd{{1, 1, 1, 1}, {0, worm.A, -worm.A, worm.A}};
   history.cycle_start = 1;
   history.cycles = 1000;
   MarchSettings settings;
   settings.stop_at_steady_state = false;
   settings.keep_increments = false;
   settings.increments = 1;
   ContactState marched = worm.state;
   marched.time = 0;
   const MarchReport report = march(worm.problem, history, marched, settings);
   ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
   // The march needs more than 40 cycles.
   EXPECT_GT(report.cycles[40].slip_change, 1e-6 * marched.v.norm());
   EXPECT_LT((loop.peak.v - marched.v).norm(), 1e-7 * marched.v.norm());
   EXPECT_LT((loop.peak.q - marched.q).norm(), 1e-7 * marched.q.norm());
   EXPECT_NEAR(loop.dissipation, report.cycles.back().dissipation, 1e-7 * loop.dissipation);

   // So few cycles are not enough.
   const ModalLoop early = worm.loop(2);
   EXPECT_FALSE(early.steady);
   EXPECT_NE(early.message.find("not steady after 2 cycles"), std::string::npos)
      << early.message;
}

/** In time the mass keeps its amplitude if a damper takes away the damping ratio of the loop,
   and its frequency is that of the first harmonic. Sliders are integrated here by themselves,
   by the leapfrog method. */
TEST(ModalLoop, KeepsItsAmplitudeInTime)
{
   MassOnSliders many;
   const int n = 40;
   many.k = VectorXd::Constant(n, 1.0 / n);
   many.s = many.k[0] * VectorXd::LinSpaced(n, 0.5, n - 0.5) / n;
   for (const double X : {0.1, 0.3, 0.7})
   {
      SCOPED_TRACE(X);
      const ModalLoop loop = many.loop(std::sqrt(many.m) * X);
      ASSERT_EQ(loop.status, FrictionStatus::converged) << loop.message;
      const double period = 2 * pi / loop.omega, dt = period / 4000;
      const int cycles = 20;
      const VectorXd most = many.s.cwiseQuotient(many.k);
      VectorXd stretch = most.cwiseMin(X); // of the springs, at the peak of the steady loop
      const auto acceleration = [&](double x, double velocity)
      {
         return 2 * loop.zeta * loop.omega * velocity -
                (many.ground * x + many.k.dot(stretch)) / many.m;
      };
      double x = X, velocity = 0.5 * dt * acceleration(X, 0), peak = 0, last_peak = 0,
             crossed = 0, first = -1;
      int crossings = 0;
      for (int step = 1; step < (cycles + 1) * 4000; ++step)
      {
         const double before = x;
         x += dt * velocity;
         stretch = (stretch.array() + dt * velocity).matrix().cwiseMin(most).cwiseMax(-most);
         velocity += dt * acceleration(x, velocity);
         peak = std::max(peak, x);
         if (before < 0 && x >= 0)
         {
            crossed = dt * (step - x / (x - before));
            if (first < 0) { first = crossed; }
            else { ++crossings; }
            last_peak = peak;
            peak = 0;
            if (crossings == cycles - 1) { break; }
         }
      }
      ASSERT_EQ(crossings, cycles - 1);
      EXPECT_NEAR(last_peak, X, 0.02 * X);
      EXPECT_NEAR(2 * pi * crossings / (crossed - first), loop.omega, 0.003 * loop.omega);
   }
}

/** A mass on two half-planes that are pressed by P = 1 with a parabola between them, a = 1. Its
    loop is that of Cattaneo and Mindlin. With N = P - Q/f the displacement is
    f (w(P) - w(N)), where w'(N) = (C - ln N)/(π E*), and C, which has the depth, follows from
    the frequency without slip. */
TEST(ModalLoop, CattaneoAndMindlin)
{
   const double m = 3, f = 0.4, modulus = 4 / pi;
   HalfPlane pad, plane;
   pad.material = plane.material = Material{8 / pi * 0.91, 0.3};
   pad.depth = plane.depth = 1e4;
   pad.normal = {0, 1};
   pad.forces = {{"P", {0, -1}}, {"mode 1", {std::sqrt(m), 0}}};
   std::vector<double> grid;
   const int elements = 240;
   for (int k = -elements; k <= elements; k += 2) { grid.push_back(1.1 * k / elements); }
   ReducedProblem problem = reduce(condense(pad, grid, 1), plane).problem;
   problem.B().setZero(); // equal half-planes
   join_coupling(problem);
   set_friction(problem, f);
   problem.gap = problem.position.col(0).cwiseAbs2() / 2;
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(march(problem, LoadHistory::through(problem, {{}, {{"P", 1}}}), state).status,
             FrictionStatus::converged);
   FrictionSolver solver(problem);
   const double omega = modal_loop(solver, problem, state, "mode 1", 1, 1e-6).omega;
   const double C = pi * modulus / (m * omega * omega);
   const auto displacement = [&](double Q)
   {
      const double N = 1 - Q / f;
      return f / (pi * modulus) * (C * Q / f + N * std::log(N) - N + 1);
   };
   std::vector<double> zeta, amplitude;
   for (const double share : {0.1, 0.2, 0.4, 0.8})
   {
      SCOPED_TRACE(share);
      const double Q = share * f, x = displacement(Q),
                   lost = fretting::hertz_slip_energy(f, 1, share, modulus);
      const ModalLoop loop =
         modal_loop(solver, problem, state, "mode 1", omega, std::sqrt(m) * x);
      ASSERT_EQ(loop.status, FrictionStatus::converged) << loop.message;
      EXPECT_NEAR(loop.force * std::sqrt(m), Q, 1e-3 * Q);
      EXPECT_NEAR(loop.omega_secant, std::sqrt(Q / (m * x)), 1e-3 * omega);
      // The slip zone is as wide as 1 - sqrt(1 - share), of elements of 0.009.
      EXPECT_NEAR(loop.dissipation, lost, (share < 0.3 ? 0.03 : 0.01) * lost);
      EXPECT_NEAR(loop.area, loop.dissipation, 1e-9 * loop.dissipation);
      zeta.push_back(loop.zeta);
      amplitude.push_back(loop.amplitude);
   }
   // At small amplitudes the loss grows with the third power, the damping ratio with the first.
   EXPECT_NEAR(std::log(zeta[1] / zeta[0]) / std::log(amplitude[1] / amplitude[0]), 1, 0.15);
}

namespace
{

/// The curve of Cattaneo and Mindlin of two spheres of shear modulus 1 and ν = 0 with a = 1:
/// shifts and, by Masing, the loss of a cycle and the first harmonic of its force.
struct SpheresInClosedForm
{
   double f, P;
   double most() const { return 0.75 * f * P; }
   double shift(double s) const { return most() * (1 - std::pow(1 - s, 2.0 / 3)); }
   /// 8 (∫Q dδ - ½ Q δ) of the first loading.
   double loss(double s) const
   {
      const double c = 1 - s, work = 0.6 - std::pow(c, 2.0 / 3) + 0.4 * std::pow(c, 5.0 / 3);
      return 8 * (f * P * most() * work - 0.5 * f * P * s * shift(s));
   }
   /// ∮ Q cos θ dθ/π with a shift of X cos θ. Unloading from the end is the first curve, twice
   /// as large.
   double harmonic(double s) const
   {
      const double X = shift(s);
      const auto first = [&](double d) { return f * P * (1 - std::pow(1 - d / most(), 1.5)); };
      double sum = 0;
      const int n = 20000;
      for (int k = 0; k < n; ++k)
      {
         const double theta = pi * (k + 0.5) / n;
         sum += (f * P * s - 2 * first(0.5 * X * (1 - std::cos(theta)))) * std::cos(theta);
      }
      return 2 * sum / n;
   }
};

} // namespace

/// A mass 1 between two spheres that are pressed, in three dimensions: the whole curves, and
/// their powers at small amplitudes, with squares and with triangles.
TEST(ModalLoop, CattaneoAndMindlinInSpace)
{
   const double f = 0.3, P = 4.0 / 3;
   const Material one = cattaneo_test::of_shear(1, 0);
   HalfSpace squares = cattaneo_test::contact_of(one, one, 2.2 / 23,
                                                 cattaneo_test::cells(23, 2.2 / 23, 1.1)),
             triangles = cattaneo_test::disc_of_triangles(one, one, 10, 1.1);
   const SpheresInClosedForm closed{f, P};
   for (const bool square : {true, false})
   {
      SCOPED_TRACE(square ? "squares" : "triangles");
      const HalfSpace &contact = square ? squares : triangles;
      const VectorXd square_of_r = square ? VectorXd(contact.centres.rowwise().squaredNorm())
                                          : cattaneo_test::mean_square(contact);
      ReducedProblem problem = contact.problem(0.5 * square_of_r);
      set_friction(problem, f);
      ContactState state = ContactState::virgin(problem);
      ASSERT_EQ(march(problem, LoadHistory::through(problem, {{}, {{"P", P}}}), state).status,
                FrictionStatus::converged);
      FrictionSolver solver(problem);
      ModalLoopSettings settings;
      settings.tolerance = 1e-6;
      settings.march.increments = 16;
      // Nothing slips: the compliance is 1/2.
      const ModalLoop small = modal_loop(solver, problem, state, "Q1", 1, 1e-6, settings);
      EXPECT_NEAR(small.omega, std::sqrt(2.0), 0.01 * std::sqrt(2.0));
      std::vector<double> sizes, shares{0.3, 0.5, 0.8};
      for (const double s : shares) { sizes.push_back(closed.shift(s)); }
      const std::vector<ModalLoop> loops =
         modal_curve(solver, problem, state, "Q1", small.omega, sizes, settings);
      std::vector<std::array<double, 3>> logs; // of amplitude, loss and damping ratio
      for (std::size_t k = 0; k < shares.size(); ++k)
      {
         SCOPED_TRACE(shares[k]);
         const ModalLoop &loop = loops[k];
         const double X = sizes[k], Q = f * P * shares[k];
         ASSERT_EQ(loop.status, FrictionStatus::converged) << loop.message;
         ASSERT_TRUE(loop.steady) << loop.message;
         EXPECT_NEAR(loop.force, Q, 0.003 * Q);
         EXPECT_NEAR(loop.omega_secant, std::sqrt(Q / X), 0.003);
         EXPECT_NEAR(loop.omega, std::sqrt(closed.harmonic(shares[k]) / X), 0.003);
         // Cells of this size show the ring of slip, of this width.
         const double cell = square ? 2.2 / 23 : 1.1 / 10, ring = 1 - std::cbrt(1 - shares[k]),
                      allowed = 0.12 * cell / ring * closed.loss(shares[k]);
         EXPECT_NEAR(loop.dissipation, closed.loss(shares[k]), allowed);
         EXPECT_NEAR(loop.area, closed.loss(shares[k]), allowed);
         EXPECT_NEAR(loop.zeta,
                     closed.loss(shares[k]) / (2 * pi * closed.harmonic(shares[k]) * X),
                     1.1 * allowed / (2 * pi * closed.harmonic(shares[k]) * X));
         EXPECT_LT(loop.omega_error, 0.002 * loop.omega);
         EXPECT_LT(loop.zeta_error, 0.02 * loop.zeta);
         logs.push_back(
            {std::log(loop.amplitude), std::log(loop.dissipation), std::log(loop.zeta)});
      }
      // At small amplitudes the loss grows with the third power, the damping ratio with the
      // first.
      if (square)
      {
         const double way = logs[1][0] - logs[0][0];
         EXPECT_NEAR((logs[1][1] - logs[0][1]) / way, 3, 0.15);
         EXPECT_NEAR((logs[1][2] - logs[0][2]) / way, 1, 0.2);
      }
   }
}

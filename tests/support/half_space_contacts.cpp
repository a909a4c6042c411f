#include "half_space_contacts.hpp"

#include <algorithm>
#include <cattaneo/readout/areas.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace cattaneo_test
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector2d;

Material of_shear(double shear_modulus, double poisson)
{
   return {2 * shear_modulus * (1 + poisson), poisson};
}

Places cells(int m, double edge, double radius, const Vector2d &middle)
{
   std::vector<Vector2d> within;
   for (int j = 0; j < m; ++j)
   {
      for (int i = 0; i < m; ++i)
      {
         const Vector2d place = 0.5 * edge * Vector2d(2 * i + 1 - m, 2 * j + 1 - m);
         if (place.norm() <= radius) { within.emplace_back(middle + place); }
      }
   }
   Places centres(static_cast<Index>(within.size()), 2);
   for (Index i = 0; i < centres.rows(); ++i)
   {
      centres.row(i) = within[static_cast<std::size_t>(i)];
   }
   return centres;
}

HalfSpace contact_of(const Material &material, std::optional<Material> other, double edge,
                     Places centres)
{
   HalfSpace contact;
   contact.material = material;
   contact.other = std::move(other);
   contact.size = {edge, edge};
   contact.centres = std::move(centres);
   return contact;
}

HalfSpace disc_of_triangles(const Material &material, std::optional<Material> other, int rings,
                            double radius)
{
   HalfSpace contact;
   contact.material = material;
   contact.other = std::move(other);
   contact.vertices.resize(1 + 3 * rings * (rings + 1), 2);
   contact.triangles.resize(6 * rings * rings, 3);
   // Ring k has 6 k vertices, the first of which is number 1 + 3 k (k - 1).
   const auto vertex = [](int ring, int place)
   { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + place % (6 * ring); };
   std::mt19937 random(1);
   const auto moved = [&]
   { return 0.2 * (2 * static_cast<double>(random()) / 4294967295 - 1); };
   contact.vertices.row(0).setZero();
   Index count = 0;
   for (int ring = 1; ring <= rings; ++ring)
   {
      for (int place = 0; place < 6 * ring; ++place)
      {
         const bool inner = ring < rings;
         const double r = radius * (ring + (inner ? moved() : 0)) / rings,
                      angle = M_PI / 3 * (place + (inner ? moved() : 0)) / ring;
         contact.vertices.row(vertex(ring, place)) << r * std::cos(angle), r * std::sin(angle);
      }
      // Between this ring and the one within it, by sixths.
      for (int sixth = 0; sixth < 6; ++sixth)
      {
         const int out = sixth * ring, in = sixth * (ring - 1);
         for (int i = 0; i < ring; ++i)
         {
            contact.triangles.row(count++) << vertex(ring - 1, in + i), vertex(ring, out + i),
               vertex(ring, out + i + 1);
            if (i == ring - 1) { continue; }
            contact.triangles.row(count++) << vertex(ring - 1, in + i),
               vertex(ring, out + i + 1), vertex(ring - 1, in + i + 1);
         }
      }
   }
   return contact;
}

Eigen::VectorXd mean_square(const HalfSpace &contact)
{
   Eigen::VectorXd means = Eigen::VectorXd::Zero(contact.nodes());
   for (Index i = 0; i < means.size(); ++i)
   {
      for (int k = 0; k < 3; ++k)
      {
         const Eigen::RowVector2d middle =
            (contact.vertices.row(contact.triangles(i, k)) +
             contact.vertices.row(contact.triangles(i, (k + 1) % 3))) /
            2;
         means[i] += middle.squaredNorm() / 3;
      }
   }
   return means;
}

int number_of(const ContactState &state, NodeState status)
{
   return static_cast<int>(std::count(state.status.begin(), state.status.end(), status));
}

int number_closed(const ContactState &state)
{
   return static_cast<int>(state.status.size()) - number_of(state, NodeState::separation);
}

double conjugate(const ReducedProblem &problem, const ContactState &state, const char *load)
{
   return conjugates(problem, state)[problem.pattern(load)];
}

MarchReport marched(const ReducedProblem &problem, const std::vector<NamedLoads> &points,
                    ContactState &state, int increments)
{
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   settings.increments = increments;
   return march(problem, LoadHistory::through(problem, points), state, settings);
}

ReducedProblem kalkers_spence(double radius)
{
   const double edge = 0.2;
   const HalfSpace contact =
      contact_of(of_shear(0.5, 0), {}, edge, cells(45, edge, radius, {1e-4, 1e-4}));
   ReducedProblem problem = contact.problem(0.004116 * contact.centres.rowwise().squaredNorm());
   set_friction(problem, 0.2986);
   return problem;
}

ShearedSpheres sheared_spheres(int cells_across)
{
   const double f = 0.3, s = 0.9, a = 1, R = 10, P = 4.0 / 3 / R, Q = s * f * P; // E* = 1
   const double full = 3 * f * P / 16 * (2 + 2);
   const auto shift = [&](double share) { return full * (1 - std::pow(1 - share, 2.0 / 3)); };
   // Masing: 4 Q δ(Q) less 8 times the area under the first loading.
   const double loss =
      4 * Q * shift(s) - 8 * f * P * full * (s - 0.6 * (1 - std::pow(1 - s, 5.0 / 3)));
   const double edge = 2 * a / cells_across;
   const HalfSpace contact = contact_of(of_shear(1, 0), of_shear(1, 0), edge,
                                        cells(cells_across + 4, edge, a + 1.5 * edge));
   ReducedProblem problem = contact.problem(contact.centres.rowwise().squaredNorm() / (2 * R));
   set_friction(problem, f);
   const NamedLoads pressed{{"P", P}, {"Q1", 0}}, there{{"P", P}, {"Q1", Q}},
      back{{"P", P}, {"Q1", -Q}};
   ContactState state = ContactState::virgin(problem);
   std::vector<NamedLoads> way{{}};
   const auto go = [&](const NamedLoads &loads)
   {
      way.push_back(loads);
      EXPECT_EQ(marched(problem, way, state).status, FrictionStatus::converged);
   };
   ShearedSpheres error;
   go(pressed);
   error.approach = conjugate(problem, state, "P") * R / (a * a) - 1;
   ContactAreas areas = contact_areas(problem, state);
   EXPECT_NEAR(areas.contact.area, M_PI * a * a, areas.contact.error);
   // Half an edge along the circumference, which the area tells well.
   EXPECT_NEAR(areas.contact.error, M_PI * a * edge, 0.02 * M_PI * a * edge);
   go(there);
   error.loading = conjugate(problem, state, "Q1") / shift(s) - 1;
   areas = contact_areas(problem, state);
   const double stuck = M_PI * a * a * std::pow(1 - s, 2.0 / 3);
   EXPECT_NEAR(areas.stick.area, stuck, areas.stick.error);
   EXPECT_NEAR(areas.slip.area, M_PI * a * a - stuck, areas.slip.error);
   EXPECT_EQ(areas.contact.nodes, areas.stick.nodes + areas.slip.nodes);
   EXPECT_EQ(areas.contact.nodes + areas.separation.nodes, problem.nodes());
   const double first = state.dissipation;
   go(pressed);
   error.unloading = conjugate(problem, state, "Q1") / (shift(s) - 2 * shift(s / 2)) - 1;
   go(back);
   go(there);
   error.loss = (state.dissipation - first) / loss - 1;
   return error;
}

} // namespace cattaneo_test

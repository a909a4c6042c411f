#include <algorithm>
#include <cattaneo/condense/smooth_side.hpp>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace
{

using namespace cattaneo;
using Eigen::Vector2d;

const double degree = std::acos(-1.0) / 180;
using Distance = std::function<double(const Vector2d &)>;

/// The farthest that the curves over a side's edges are from what they should be.
double farthest(const SidePolygon &side, const Distance &distance)
{
   const std::vector<EdgeBend> bends = smooth_curve(side);
   double most = 0;
   for (std::size_t e = 0; e < bends.size(); ++e)
   {
      const Vector2d from = side.vertices[e],
                     chord = side.vertices[(e + 1) % side.vertices.size()] - from;
      for (double s = 0.05; s < 1; s += 0.1)
      {
         const Vector2d x = from + s * chord + bends[e].off(s) * Vector2d(chord[1], -chord[0]);
         most = std::max(most, std::abs(distance(x)));
      }
   }
   return most;
}

/// Degrees.
double largest_bend(const SidePolygon &side)
{
   double most = 0;
   for (const EdgeBend &bend : smooth_curve(side))
   {
      most = std::max({most, std::abs(bend.begin), std::abs(bend.end)});
   }
   return most / degree;
}

/// Edges of length 1 that turn by these degrees from one to the next.
std::vector<Vector2d> walk(const std::vector<double> &turns)
{
   std::vector<Vector2d> all{{0, 0}};
   double angle = 0;
   for (std::size_t k = 0; k <= turns.size(); ++k)
   {
      all.push_back(all.back() + Vector2d(std::cos(angle), std::sin(angle)));
      if (k < turns.size()) { angle += turns[k] * degree; }
   }
   return all;
}

/// Circles, whatever the distances of their vertices, their size, place and sense of turning:
/// the radius to round-off, of noise of 1e-12 to what that makes of curvatures.
TEST(SmoothSide, MeetsCirclesExactly)
{
   std::mt19937 random(1);
   std::uniform_real_distribution<double> any(-1, 1);
   for (int n : {12, 24, 57, 240})
   {
      for (double radius : {1e-3, 1.0, 250.0})
      {
         for (double noise : {0.0, 1e-12})
         {
            const Vector2d middle = 3 * radius * Vector2d(any(random), any(random));
            const bool hole = n % 2 == 1, loop = n != 57;
            SidePolygon side;
            side.loop = loop;
            for (int k = 0; k < n; ++k)
            {
               const double uneven = n > 12 ? 0.2 * any(random) : 0;
               const double angle = (hole ? -1 : 1) * (k + uneven) * 2 * M_PI / n;
               const Vector2d off(any(random), any(random));
               side.vertices.push_back(middle +
                                       radius * Vector2d(std::cos(angle), std::sin(angle)) +
                                       noise * radius * off);
            }
            const double off = farthest(side, [&](const Vector2d &x)
                                        { return ((x - middle).norm() - radius) / radius; });
            EXPECT_LT(off, noise > 0 ? 10 * noise : 1e-14) << n << " " << radius;
         }
      }
   }
}

/// Other curves to the fourth order of the edges' length.
TEST(SmoothSide, ConvergesToEllipses)
{
   for (double a : {1.5, 3.0})
   {
      double before = 0;
      for (int n : {48, 96, 192})
      {
         SidePolygon side;
         side.loop = true;
         for (int k = 0; k < n; ++k)
         {
            side.vertices.emplace_back(a * std::cos(2 * M_PI * k / n),
                                       std::sin(2 * M_PI * k / n));
         }
         const double off = farthest(side,
                                     [&](const Vector2d &x)
                                     {
                                        const double f =
                                           x[0] * x[0] / (a * a) + x[1] * x[1] - 1;
                                        return f / (2 * std::hypot(x[0] / (a * a), x[1]));
                                     });
         if (before > 0) { EXPECT_LT(off, before / 13) << a << " " << n; }
         before = off;
      }
   }
}

/// An arc between two straight flanks: flanks stay straight, the arc is one of a circle,
/// whether a file knows where it begins or not, calls all of it one curve, or has few digits.
TEST(SmoothSide, ArcsJoinStraightFlanks)
{
   enum File
   {
      knows_nothing,
      knows_the_arc,
      calls_all_one
   };
   std::mt19937 random(5);
   std::uniform_real_distribution<double> any(-1, 1);
   for (int n : {3, 4, 9, 30})
   {
      for (const File file : {knows_nothing, knows_the_arc, calls_all_one})
      {
         for (const double noise : {0.0, 1e-12, 1e-9, 1e-6})
         {
            SidePolygon side;
            for (int k = 5; k > 0; --k) { side.vertices.emplace_back(-0.2 * k, -1); }
            for (int k = 0; k < n; ++k)
            {
               const double angle = (k / double(n) - 1) * M_PI / 2;
               side.vertices.emplace_back(std::cos(angle), std::sin(angle));
            }
            for (int k = 0; k <= 5; ++k) { side.vertices.emplace_back(1, 0.2 * k); }
            for (Vector2d &x : side.vertices)
            {
               x += noise * Vector2d(any(random), any(random));
            }
            if (file == knows_the_arc)
            {
               side.curves.assign(5, 1);
               side.curves.insert(side.curves.end(), n, 2);
               side.curves.insert(side.curves.end(), 5, 3);
            }
            if (file == calls_all_one) { side.curves.assign(n + 10, 1); }
            const double off =
               farthest(side,
                        [](const Vector2d &x) {
                           return x[0] < 0 ? x[1] + 1 : x[1] > 0 ? x[0] - 1 : x.norm() - 1;
                        });
            EXPECT_LT(off, std::max(1e-14, 30 * noise)) << n << file << " " << noise;
         }
      }
   }
}

/// Without a file that knows: flanks of any length, of a single edge between two arcs as well,
/// with vertices to twelve digits, as decks have them.
TEST(SmoothSide, FlanksOfAnyLengthStayStraight)
{
   std::mt19937 random(5);
   std::uniform_real_distribution<double> any(-1e-12, 1e-12);
   for (int edges : {1, 2, 5})
   {
      for (int n : {4, 5, 15})
      {
         for (double flank : {0.05, 0.3, 2.0})
         {
            SidePolygon side;
            const double half = 0.5 * edges * flank;
            for (int k = 0; k <= n; ++k)
            {
               const double angle = (k / double(n) - 2) * M_PI / 2;
               side.vertices.emplace_back(std::cos(angle) - half, std::sin(angle) + 1);
            }
            for (int k = 1; k < edges; ++k) { side.vertices.emplace_back(k * flank - half, 0); }
            for (int k = 0; k <= n; ++k)
            {
               const double angle = (k / double(n) - 1) * M_PI / 2;
               side.vertices.emplace_back(std::cos(angle) + half, std::sin(angle) + 1);
            }
            for (Vector2d &vertex : side.vertices)
            {
               vertex += Vector2d(any(random), any(random));
            }
            const double off =
               farthest(side,
                        [&](const Vector2d &x)
                        {
                           return std::abs(x[0]) < half
                                     ? x[1]
                                     : Vector2d(std::abs(x[0]) - half, x[1] - 1).norm() - 1;
                        });
            EXPECT_LT(off, 1e-9) << edges << " " << n << " " << flank;
         }
      }
   }
}

/// A wave that ends near its inflection is no flank there.
TEST(SmoothSide, WavesAreCurvesUpToTheirEnds)
{
   for (double end : {1.2, 1.4, 1.5, 1.6})
   {
      for (int n : {12, 16, 20, 24, 32, 48})
      {
         SidePolygon side;
         for (int k = 0; k <= n; ++k)
         {
            const double x = end * (2.0 * k / n - 1);
            side.vertices.emplace_back(x, -0.3 * std::cos(x));
         }
         const std::vector<EdgeBend> bends = smooth_curve(side);
         const double slope = 0.3 * std::sin(end - end / n), h = 2 * end / n,
                      curvature =
                         0.3 * std::cos(end - end / n) / std::pow(1 + slope * slope, 1.5);
         // Half of what the last edge spans, to the next order of its length.
         const double half = 0.5 * h * std::hypot(1, slope) * curvature;
         for (const EdgeBend &bend : {bends.front(), bends.back()})
         {
            EXPECT_NEAR(0.5 * (bend.begin + bend.end), half, 0.15 * h * h) << end << " " << n;
         }
      }
   }
}

/// A circle of several curves of the file, some with a single edge, is one; and so is an arc
/// that its file knows between flanks that it knows, also one of three edges.
TEST(SmoothSide, GoesOnAcrossCurvesOfTheFile)
{
   SidePolygon circle;
   circle.loop = true;
   circle.curves = {1, 1, 1, 1, 1, 2, 3, 4, 4, 4, 5, 6, 6, 6, 6};
   const double n = static_cast<double>(circle.curves.size());
   for (int k = 0; k < n; ++k)
   {
      const double angle = 2 * M_PI * (k + (k % 3) * 0.2) / n;
      circle.vertices.emplace_back(std::cos(angle), std::sin(angle));
   }
   EXPECT_LT(farthest(circle, [](const Vector2d &x) { return x.norm() - 1; }), 1e-13);
   SidePolygon fillet{walk({0, 0, 7.5, 15, 15, 7.5, 0, 0})};
   fillet.curves = {1, 1, 1, 2, 2, 2, 3, 3, 3};
   const std::vector<EdgeBend> bends = smooth_curve(fillet);
   for (int e = 0; e < 9; ++e)
   {
      EXPECT_NEAR(bends[e].begin, fillet.curves[e] == 2 ? 7.5 * degree : 0, 1e-12) << e;
      EXPECT_NEAR(bends[e].end, fillet.curves[e] == 2 ? 7.5 * degree : 0, 1e-12) << e;
   }
}

/// Half of an ellipse at its planes of symmetry is what it is as a whole; without them its ends
/// are one-sided.
TEST(SmoothSide, GoesOnAsItsMirrorImage)
{
   const int n = 40;
   const double a = 2;
   SidePolygon whole, half;
   whole.loop = true;
   for (int k = 0; k < n; ++k)
   {
      const double angle = 2 * M_PI * k / n - M_PI / 2;
      whole.vertices.emplace_back(a * std::cos(angle), std::sin(angle));
      if (k <= n / 2) { half.vertices.push_back(whole.vertices.back()); }
   }
   const std::vector<EdgeBend> all = smooth_curve(whole), one_sided = smooth_curve(half);
   half.beyond = {Vector2d(0, 1), Vector2d(0, -1)};
   const std::vector<EdgeBend> mirrored = smooth_curve(half);
   for (int e = 0; e < n / 2; ++e)
   {
      EXPECT_NEAR(mirrored[e].begin, all[e].begin, 1e-13) << e;
      EXPECT_NEAR(mirrored[e].end, all[e].end, 1e-13) << e;
      EXPECT_NEAR(one_sided[e].begin, all[e].begin, 0.05 * all[e].begin) << e;
   }
   // The other way round it is the same curve.
   std::reverse(half.vertices.begin(), half.vertices.end());
   half.beyond = {half.beyond[1], half.beyond[0]};
   const std::vector<EdgeBend> back = smooth_curve(half);
   for (int e = 0; e < n / 2; ++e)
   {
      EXPECT_NEAR(back[n / 2 - 1 - e].begin, -mirrored[e].end, 1e-13) << e;
   }
}

/// What is a polygon stays one: chamfers of one edge and of several, facets, a profile of
/// points, with a file that knows nothing and with one that calls all of it one curve.
TEST(SmoothSide, LeavesPolygons)
{
   const std::vector<std::vector<double>> turns = {{0, 0, 0, 20, 0, 0, 0, 70, 0, 0},
                                                   {0, 0, 20, 70, 0, 0},
                                                   {0, 0, 0, 20, 20, 0, 0},
                                                   {0, 0, 45, 45, 0, 0},
                                                   {0, 0, 20, 0, 0, 0},
                                                   {0, 0, 5, 0, 0, 0},
                                                   {20},
                                                   {0, 15, 0, 15, 0, 15, 0},
                                                   {0, 0, 15, 0, 0, 15, 0, 0, 15}};
   for (bool known : {false, true})
   {
      for (const std::vector<double> &each : turns)
      {
         SidePolygon side{walk(each)};
         if (known && each.size() > 1) { side.curves.assign(each.size() + 1, 7); }
         EXPECT_EQ(largest_bend(side), 0) << testing::PrintToString(each) << known;
      }
      for (int edges : {2, 3}) // of a facet
      {
         SidePolygon shaft;
         shaft.loop = true;
         for (int k = 0; k < 24 * edges; ++k)
         {
            const auto corner = [](int f)
            { return Vector2d(std::cos(f * M_PI / 12), std::sin(f * M_PI / 12)); };
            const double share = double(k % edges) / edges;
            shaft.vertices.push_back((1 - share) * corner(k / edges) +
                                     share * corner(k / edges + 1));
         }
         if (known) { shaft.curves.assign(24 * edges, 7); }
         EXPECT_LT(largest_bend(shaft), 1e-12) << edges << known;
      }
      std::mt19937 random(3);
      std::uniform_real_distribution<double> height(-0.05, 0.05);
      SidePolygon profile;
      for (int k = 0; k < 200; ++k) { profile.vertices.emplace_back(k, height(random)); }
      if (known) { profile.curves.assign(199, 7); }
      EXPECT_EQ(largest_bend(profile), 0);
   }
   // A measured profile with a curve of the file for each of its edges, also where what is
   // beyond its ends would go on as a mirror image.
   SidePolygon measured{walk({3, -5, 1, 4, -2, -1, 6, -7, 2, -3, 5})};
   for (int k = 0; k < 12; ++k) { measured.curves.push_back(k + 1); }
   measured.beyond = {Vector2d(0, -1), Vector2d(0, 1)};
   EXPECT_EQ(largest_bend(measured), 0);
   // Facets of one edge each, which their file knows.
   SidePolygon facets{walk(std::vector<double>(23, 15))};
   EXPECT_NEAR(largest_bend(facets), 7.5, 1e-9);
   for (int k = 0; k < 24; ++k) { facets.curves.push_back(k + 1); }
   EXPECT_EQ(largest_bend(facets), 0);
}

std::vector<double> joined(const std::vector<std::vector<double>> &parts)
{
   std::vector<double> all;
   for (const std::vector<double> &part : parts)
   {
      all.insert(all.end(), part.begin(), part.end());
   }
   return all;
}

/// An arc of nine edges beside facets of three edges, chamfers of two or a serration, in a file
/// that knows nothing: it is an arc, and the others are what they are.
TEST(SmoothSide, ArcsAreSuchBesideFacetsAndChamfers)
{
   const std::vector<double> arc(8, 6);
   std::vector<double> facets, serration{12};
   for (int k = 0; k < 8; ++k)
   {
      facets.insert(facets.end(), {0, 0, 15});
      serration.insert(serration.end(), {-24, 24});
   }
   const std::vector<double> chamfer{0, 0, 20, 20, 0, 0};
   const std::vector<std::vector<double>> others{facets, chamfer, joined({chamfer, chamfer})};
   for (const std::vector<double> &other : others)
   {
      // A corner between both.
      const SidePolygon side{walk(joined({other, {-25}, arc, {-25}, other}))};
      const std::vector<EdgeBend> bends = smooth_curve(side);
      for (std::size_t e = 0; e < bends.size(); ++e)
      {
         const bool of_arc = e > other.size() && e < other.size() + 10;
         EXPECT_NEAR(bends[e].begin, of_arc ? 3 * degree : 0, 1e-9) << e;
         EXPECT_NEAR(bends[e].end, of_arc ? 3 * degree : 0, 1e-9) << e;
      }
   }
   // Beside a serration the arc may be a part of a profile: it is one, or is said to be
   // possible.
   const SidePolygon side{walk(joined({serration, {-6}, arc}))};
   const std::vector<EdgeBend> bends = smooth_curve(side), possible = possible_curve(side);
   for (std::size_t e = bends.size() - 7; e < bends.size(); ++e)
   {
      EXPECT_NEAR(std::max(bends[e].begin, possible[e].begin), 3 * degree, 1e-9) << e;
   }
}

/// A slightly crowned side between chamfers of a hundred and more times its turns.
TEST(SmoothSide, CrownsAreCurvesBesideChamfers)
{
   for (double crown : {1e-3, 0.02, 0.1})
   {
      for (const std::vector<double> &chamfer :
           {std::vector<double>{0, 0, 20}, std::vector<double>{0, 15, 15}})
      {
         std::vector<double> back = chamfer;
         std::reverse(back.begin(), back.end());
         for (bool known : {false, true})
         {
            SidePolygon side{walk(joined({chamfer, std::vector<double>(8, crown), back}))};
            const std::size_t first = chamfer.size(), count = side.vertices.size() - 1;
            for (std::size_t e = 0; e < count && known; ++e)
            {
               side.curves.push_back(e < first ? 1 : e < first + 9 ? 2 : 3);
            }
            const std::vector<EdgeBend> bends = smooth_curve(side);
            for (std::size_t e = 0; e < count; ++e)
            {
               const bool of_crown = e >= first && e < first + 9;
               EXPECT_NEAR(bends[e].begin, of_crown ? crown / 2 * degree : 0, 1e-9) << e;
               EXPECT_NEAR(bends[e].end, of_crown ? crown / 2 * degree : 0, 1e-9) << e;
            }
         }
      }
   }
}

/// A side that meets the next one at another angle than 90 degrees has no mirror image there,
/// however near that is: neither a flank, whose arc its file knows, nor an arc.
TEST(SmoothSide, EndsWhereItMeetsNoMirrorImage)
{
   for (double off : {-15.0, -5.0, -1.0, -0.01, 0.0, 0.01, 1.0, 5.0, 15.0})
   {
      for (bool of_one_curve : {false, true})
      {
         SidePolygon fillet{walk({0, 10, 20, 10, 0})};
         fillet.curves = {1, 1, 2, 2, 3, 3};
         if (of_one_curve) { fillet.curves.assign(6, 7); }
         const std::vector<EdgeBend> alone = smooth_curve(fillet);
         const double end = (40 + 90 + off) * degree, begin = (90 + off) * degree;
         fillet.beyond = {Vector2d(std::cos(begin), std::sin(begin)),
                          Vector2d(std::cos(end), std::sin(end))};
         const std::vector<EdgeBend> bends = smooth_curve(fillet);
         for (std::size_t e = 0; e < bends.size(); ++e)
         {
            EXPECT_NEAR(bends[e].begin, alone[e].begin, 1e-9) << off << e;
            EXPECT_NEAR(bends[e].end, alone[e].end, 1e-9) << off << e;
         }
      }
      SidePolygon arc{walk(std::vector<double>(8, 5))};
      const double end = (40 + 2.5 + 90 + off) * degree;
      arc.beyond[1] = Vector2d(std::cos(end), std::sin(end));
      // A plane is one to a hundredth of a degree: its image then meets at twice that.
      const double allowed = 1e-9 + (std::abs(off) < 0.1 ? 1.01 * std::abs(off) * degree : 0);
      for (const EdgeBend &bend : smooth_curve(arc))
      {
         EXPECT_NEAR(bend.begin, 2.5 * degree, allowed) << off;
         EXPECT_NEAR(bend.end, 2.5 * degree, allowed) << off;
      }
   }
}

/// Three edges that turn alike are kept a polygon, and may be an arc; a chamfer, facets and a
/// corner may not.
TEST(SmoothSide, TellsWhichPolygonsMayBeArcs)
{
   const auto largest = [](const SidePolygon &side)
   {
      double most = 0;
      for (const EdgeBend &bend : possible_curve(side))
      {
         most = std::max({most, std::abs(bend.begin), std::abs(bend.end)});
      }
      return most / degree;
   };
   EXPECT_NEAR(largest({walk({12, 12})}), 6, 1e-9);
   EXPECT_NEAR(largest({walk({0, 0, 60, 10, 10, 60, 0, 0})}), 5, 1e-9);
   EXPECT_EQ(largest({walk({0, 0, 20, 20, 0, 0})}), 0);
   EXPECT_EQ(largest({walk({0, 0, 20, 0, 0})}), 0);
   EXPECT_EQ(largest({walk({0, 0, 15, 0, 0, 15, 0, 0, 15, 0, 0})}), 0);
   EXPECT_EQ(largest({walk({5, 5, 5, 5, 5, 5})}), 0); // an arc
}

/// Heights of points at random are a profile: of a thousand, in all of which nothing is curved.
TEST(SmoothSide, LeavesProfilesOfAnyHeights)
{
   std::mt19937 random(17);
   std::uniform_real_distribution<double> any(-1, 1);
   int curved = 0;
   for (int k = 0; k < 1000; ++k)
   {
      SidePolygon side;
      double walked = 0;
      for (int i = 0; i < 60; ++i)
      {
         walked += 0.03 * any(random);
         side.vertices.emplace_back(i, k % 2 == 0 ? walked : 0.05 * any(random));
      }
      curved += largest_bend(side) > 0;
   }
   EXPECT_EQ(curved, 0);
}

/// The direction of a curve is that of its places.
TEST(SmoothSide, SlopesAreOfTheCurve)
{
   for (const EdgeBend &bend : {EdgeBend{0.1, 0.1}, EdgeBend{-0.3, 0.2}, EdgeBend{0.5, 0.45}})
   {
      for (double s : {0.0, 0.1, 0.5, 0.8, 1.0})
      {
         const double h = 1e-5;
         EXPECT_NEAR(bend.slope(s), (bend.off(s + h) - bend.off(s - h)) / (2 * h), 1e-9);
      }
   }
}

/// Real corners between arcs stay corners: each arc is one to its end.
TEST(SmoothSide, KeepsCorners)
{
   for (double corner : {-90.0, -15.0, 15.0, 40.0, 90.0})
   {
      const SidePolygon side{walk({5, 5, 5, 5, 5 + corner, 5, 5, 5, 5})};
      for (const EdgeBend &bend : smooth_curve(side))
      {
         EXPECT_NEAR(bend.begin, 2.5 * degree, 1e-12) << corner;
         EXPECT_NEAR(bend.end, 2.5 * degree, 1e-12) << corner;
      }
   }
   // Three edges of an arc with free ends have two turns, which tell nothing but to their file.
   SidePolygon arc{walk({12, 12})};
   EXPECT_EQ(largest_bend(arc), 0);
   arc.curves = {4, 4, 4};
   EXPECT_NEAR(largest_bend(arc), 6, 1e-9);
}

} // namespace

#include <algorithm>
#include <cattaneo/condense/smooth_side.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Vector2d;

namespace
{

const double degree = std::acos(-1.0) / 180;
/// Angle in radians by which round-off of coordinates may turn an edge.
constexpr double round_off = 1e-6;

double cross(const Vector2d &a, const Vector2d &b)
{
   return a[0] * b[1] - a[1] * b[0];
}

/// Number of vertices that are added beyond an end to continue the side. It is larger than the
/// longest run of turns that is looked at.
constexpr int beyond_end = 8;
/// Number of vertices on each side of a vertex that tell whether it belongs to a profile that
/// turns left and right alternately.
constexpr int around_profile = 8;

/** A side that continues beyond its ends if it is a loop or has a mirror image there. */
class OpenSide
{
public:
   explicit OpenSide(const SidePolygon &side);
   std::vector<EdgeBend> bends();
   /// Does the curve with these bends continue smoothly into the assumed mirror image at an
   /// end? True without an image.
   bool meets_image(bool end) const;
   /// To be called after bends(): arcs that may include vertices which bends() has taken for
   /// corners.
   std::vector<EdgeBend> possible() const;

private:
   using Vertices = std::vector<Vector2d>;

   void measure();
   void find_steady_runs();
   void classify();
   void join_curves();
   bool find_corners();
   void find_short_runs();
   void drop_profile();
   bool to_and_fro(int i) const;
   bool fits_flank(int i, int way, double within = 0.1) const;
   void find_joints();
   EdgeBend bend(int edge) const;
   void meet(std::vector<EdgeBend> &all) const;
   std::vector<EdgeBend> all_bends() const;
   std::vector<EdgeBend> of_edges(const std::vector<EdgeBend> &all) const;

   /// A smaller turn is due to round-off.
   double flat(int i) const { return steady_[i] ? round_off : flat_; }
   int last() const { return static_cast<int>(x_.size()) - 1; }
   bool within(int i) const { return curve_[i - 1] >= 0 && curve_[i - 1] == curve_[i]; }
   bool inside(int i) const { return within(i) || (curve_[i - 1] >= 0 && joined_[i]); }
   bool parts(int i) const { return curve_[i - 1] != curve_[i] && !joined_[i]; }
   /// Is the curvature of both edges that of the circle through this vertex and its neighbours?
   bool tells(int i) const
   {
      return i > 0 && i < last() && !corner_[i] && !parts(i) && joint_[i] == 0;
   }
   double arc(int edge, double curvature) const
   {
      return std::asin(std::clamp(0.5 * length_[edge] * curvature, -0.9, 0.9));
   }

   Vertices x_;
   std::vector<int> curve_; ///< of each edge
   int first_ = 0;          ///< edge that was the first
   std::size_t edges_ = 0;  ///< how many there were
   std::vector<double> length_, along_, turn_, curvature_, centre_;
   /// Smaller turns are round-off, unless they follow each other steadily.
   double flat_ = 0;
   std::array<int, 2> tip_{-1, -1}; ///< vertices beyond which there is a mirror image
   std::vector<bool> steady_, corner_, joined_;
   std::vector<bool> distinct_; ///< corners by the angle or by the vertices beside them
   std::vector<int>
      joint_; ///< -1: joint of an arc before and a straight flank after, 1: the reverse
};

OpenSide::OpenSide(const SidePolygon &side) : x_(side.vertices)
{
   const auto n = static_cast<int>(x_.size());
   edges_ = side.loop ? n : n - 1;
   curve_ = side.curves.size() == edges_ ? side.curves : std::vector<int>(edges_, -1);
   if (side.loop)
   {
      // A vertex or edge before the first one is counted from the end of the loop, any number
      // of rounds.
      Vertices around;
      std::vector<int> curves;
      for (int k = -beyond_end; k <= n + beyond_end; ++k)
      {
         const int at = ((k % n) + n) % n;
         around.push_back(x_[at]);
         if (k < n + beyond_end) { curves.push_back(curve_[at]); }
      }
      x_ = std::move(around);
      curve_ = std::move(curves);
      first_ = beyond_end;
      return;
   }
   for (const bool end : {true, false})
   {
      const Vector2d &way = side.beyond[end];
      const int tip = end ? last() : 0, step = end ? -1 : 1;
      if (way.isZero(0) || last() < 1) { continue; }
      const Vector2d axis = way.normalized(), out = (x_[tip] - x_[tip + step]).normalized();
      // Half of the turn between the edge and its image.
      if (std::abs(out.dot(axis)) > std::sin(0.5 * SidePolygon::corner * degree)) { continue; }
      const int images = std::min(beyond_end, last());
      // A curve of the file with a single edge has no vertex inside, and so none at the tip
      // either: its image is another curve.
      const int edges = static_cast<int>(curve_.size()), at_tip = end ? edges - 1 : 0;
      const bool single = edges < 2 || curve_[at_tip] != curve_[at_tip + step];
      const int another = single ? 1 + *std::max_element(curve_.begin(), curve_.end()) : 0;
      Vertices more;
      std::vector<int> curves;
      for (int k = 1; k <= images; ++k)
      {
         const Vector2d from = x_[tip + k * step] - x_[tip];
         more.push_back(x_[tip] + 2 * axis.dot(from) * axis - from);
         const int curve = curve_[end ? edges - k : k - 1];
         curves.push_back(curve < 0 ? curve : curve + another);
      }
      if (end)
      {
         tip_[1] = tip;
         x_.insert(x_.end(), more.begin(), more.end());
         curve_.insert(curve_.end(), curves.begin(), curves.end());
      }
      else
      {
         x_.insert(x_.begin(), more.rbegin(), more.rend());
         curve_.insert(curve_.begin(), curves.rbegin(), curves.rend());
         first_ = images;
         tip_[0] = images;
         if (tip_[1] >= 0) { tip_[1] += images; }
      }
   }
}

/// Computes the turns at the vertices, and the curvatures of circles through three of them.
/// These are the curvatures of the curve at the mean of the three places.
void OpenSide::measure()
{
   const auto n = x_.size();
   length_.assign(n - 1, 0);
   along_.assign(n, 0);
   turn_ = curvature_ = centre_ = std::vector<double>(n, 0);
   for (std::size_t e = 0; e + 1 < n; ++e)
   {
      length_[e] = (x_[e + 1] - x_[e]).norm();
      along_[e + 1] = along_[e] + length_[e];
   }
   for (std::size_t i = 1; i + 1 < n; ++i)
   {
      const Vector2d before = x_[i] - x_[i - 1], after = x_[i + 1] - x_[i];
      turn_[i] = std::atan2(cross(before, after), before.dot(after));
      curvature_[i] = 2 * cross(before, after) /
                      (length_[i - 1] * length_[i] * std::max((before + after).norm(), 1e-300));
      centre_[i] = (along_[i - 1] + along_[i] + along_[i + 1]) / 3;
   }
   // In files of few digits straight flanks turn left and right alternately.
   double largest = 0;
   for (const double turn : turn_)
   {
      if (std::abs(turn) < SidePolygon::corner * degree)
      {
         largest = std::max(largest, std::abs(turn));
      }
   }
   flat_ = std::max(round_off, 0.01 * largest);
   corner_ = joined_ = std::vector<bool>(n, false);
   joint_.assign(n, 0);
   find_steady_runs();
}

/// Four or more turns in a row in one direction, of similar curvature, are not round-off, which
/// alternates in sign. Even small ones belong to a slightly crowned side, however much a
/// chamfer beside it turns.
void OpenSide::find_steady_runs()
{
   steady_.assign(x_.size(), false);
   const auto goes_on = [&](int i) // from i - 1
   {
      const double a = curvature_[i - 1], b = curvature_[i];
      return a * b > 0 && std::min(std::abs(turn_[i - 1]), std::abs(turn_[i])) > round_off &&
             std::max(std::abs(a), std::abs(b)) <= 1.5 * std::min(std::abs(a), std::abs(b));
   };
   for (int begin = 1, end = 1; begin < last(); begin = end)
   {
      for (end = begin + 1; end < last() && goes_on(end);) { ++end; }
      if (end - begin >= 4) { std::fill_n(steady_.begin() + begin, end - begin, true); }
   }
}

/// An arc may consist of several curves of the file, some with a single edge. An end of a curve
/// does not count as one if the curvature is the same at both vertices beside it and also at a
/// vertex within a curve. Without such a vertex all of them are facets.
void OpenSide::join_curves()
{
   const auto alike = [&](int i, int j)
   {
      const double a = curvature_[i], b = curvature_[j];
      return std::abs(turn_[i]) > flat(i) && std::abs(turn_[j]) > flat(j) &&
             std::abs(a - b) <= 0.05 * std::max(std::abs(a), std::abs(b));
   };
   for (int begin = 1, end = 1; begin < last(); begin = end)
   {
      bool arc = within(begin);
      for (end = begin + 1; end < last() && alike(end - 1, end); ++end)
      {
         arc = arc || within(end);
      }
      if (!arc) { continue; }
      for (int i = begin; i < end; ++i)
      {
         const bool before = i > begin || i == 1, after = i + 1 < end || i + 1 == last();
         joined_[i] = before && after && end - begin > 1 && curve_[i - 1] != curve_[i] &&
                      std::min(curve_[i - 1], curve_[i]) >= 0;
      }
   }
}

/// Finds corners by the angle, and by comparison with the vertices beside them. False if a
/// corner is within a curve of the file, which then is not a curve.
bool OpenSide::find_corners()
{
   corner_.assign(x_.size(), false);
   bool true_curves = true;
   for (int i = 1; i < last(); ++i)
   {
      const double most = inside(i) ? SidePolygon::corner_within : SidePolygon::corner;
      corner_[i] = std::abs(turn_[i]) > most * degree;
      true_curves = true_curves && !(corner_[i] && inside(i));
   }
   for (bool more = true; more;)
   {
      const std::vector<bool> before = corner_;
      more = false;
      for (int i = 1; i < last(); ++i)
      {
         if (before[i] || parts(i)) { continue; }
         const auto known = [&](int j)
         { return j > 0 && j < last() && !before[j] && !parts(j); };
         const bool left = known(i - 1), right = known(i + 1);
         bool is_corner = false;
         if (!left && !right) { is_corner = !inside(i); }
         else
         {
            // A neighbour without information counts like the other neighbour.
            const double on_left = curvature_[left ? i - 1 : i + 1],
                         on_right = curvature_[right ? i + 1 : i - 1];
            const double expected = arc(i - 1, on_left) + arc(i, on_right);
            const double largest = std::max(std::abs(on_left), std::abs(on_right)) * 0.5 *
                                   (length_[i - 1] + length_[i]);
            is_corner =
               std::abs(turn_[i] - expected) > (inside(i) ? 1.5 : 1.2) * largest + flat(i);
         }
         if (is_corner)
         {
            corner_[i] = more = true;
            true_curves = true_curves && !inside(i);
         }
      }
   }
   return true_curves;
}

/// If no curve is known: turns in one direction that are too few to tell an arc from a chamfer.
void OpenSide::find_short_runs()
{
   const auto counts = [&](int i)
   {
      if (i < 1 || i >= last() || corner_[i]) { return false; }
      // Corners give no information about the edges beside them.
      const auto turn = [&](int j)
      { return j > 0 && j < last() && !distinct_[j] ? std::abs(turn_[j]) : 0; };
      const double beside = std::max(turn(i - 1), turn(i + 1));
      return std::abs(turn_[i]) > std::max(flat(i), 0.1 * beside);
   };
   for (int begin = 1; begin < last();)
   {
      if (!counts(begin))
      {
         ++begin;
         continue;
      }
      int end = begin + 1;
      double least = std::abs(curvature_[begin]), most = least;
      bool known = inside(begin);
      while (counts(end) && turn_[end] * turn_[begin] > 0)
      {
         least = std::min(least, std::abs(curvature_[end]));
         most = std::max(most, std::abs(curvature_[end]));
         known = known || inside(end);
         ++end;
      }
      const int turns = end - begin;
      // If a straight flank would be on the same curve as an arc, the curve of the file is not
      // used.
      const auto flank = [&](int i)
      { return i > 0 && i < last() && inside(i) && !corner_[i] && !counts(i); };
      known = known && !(flank(begin - 1) && !parts(begin)) && !(flank(end) && !parts(end - 1));
      if (!known && (turns < 3 || (turns == 3 && least < 0.6 * most)))
      {
         for (int i = begin; i < end; ++i) { corner_[i] = true; }
      }
      begin = end;
   }
}

/// Is a vertex a corner that turns in the other direction than one beside it, by a similar
/// angle? A chamfer or a facet turns in one direction.
bool OpenSide::to_and_fro(int i) const
{
   const auto against = [&](int j)
   {
      return j > 0 && j < last() && turn_[i] * turn_[j] < 0 &&
             std::abs(turn_[j]) >= 0.1 * std::abs(turn_[i]);
   };
   return corner_[i] && (against(i - 1) || against(i + 1));
}

/// Finds measured profiles. If a third of the turning vertices turn left and right alternately,
/// the others do not lie on a curve either. Only the vertices around each one count, because
/// other parts of the side may be different. A few vertices beside them that turn in one
/// direction do so by chance, unless there are twelve, or five with similar turns.
void OpenSide::drop_profile()
{
   std::vector<bool> dropped = corner_;
   for (int i = 1; i < last(); ++i)
   {
      const int from = std::max(1, i - around_profile),
                to = std::min(last() - 1, i + around_profile);
      double largest = 0;
      for (int j = from; j <= to; ++j)
      {
         const double turn = std::abs(turn_[j]);
         if (turn < SidePolygon::corner * degree) { largest = std::max(largest, turn); }
      }
      int turns = 0, odd = 0;
      for (int j = from; j <= to; ++j)
      {
         const double turn = std::abs(turn_[j]);
         if (turn > SidePolygon::corner * degree || turn < 0.02 * largest) { continue; }
         ++turns;
         odd += to_and_fro(j);
      }
      dropped[i] = dropped[i] || (3 * odd > turns && !inside(i));
   }
   std::vector<bool> odd(x_.size(), false);
   for (int i = 1; i < last(); ++i) { odd[i] = to_and_fro(i); }
   corner_ = dropped;
   const auto kept = [&](int i) { return i > 0 && i < last() && !corner_[i]; };
   for (int begin = 1, end = 1; begin < last(); begin = end)
   {
      end = begin + 1;
      if (!kept(begin)) { continue; }
      bool alike = true, known = inside(begin);
      for (; kept(end); ++end)
      {
         const double a = curvature_[end - 1], b = curvature_[end];
         alike = alike && std::abs(a - b) <= 0.2 * std::max(std::abs(a), std::abs(b));
         known = known || inside(end);
      }
      const int from = std::max(1, begin - around_profile),
                to = std::min(last(), end + around_profile);
      const bool beside = std::count(odd.begin() + from, odd.begin() + to, true) > 1;
      if (beside && !known && end - begin < (alike ? 5 : 12))
      {
         std::fill_n(corner_.begin() + begin, end - begin, true);
      }
   }
}

/// Is a vertex the joint of an arc on this side of it (-1: before, 1: after) and a straight
/// flank? It then turns by half of the angle that the arc's edge spans. The tolerance is this
/// share of the additional turn if the arc went on.
bool OpenSide::fits_flank(int i, int way, double within) const
{
   if (!tells(i) || !tells(i + way)) { return false; }
   const double curvature = curvature_[i + way], half = arc(way < 0 ? i - 1 : i, curvature),
                more = arc(way < 0 ? i : i - 1, curvature);
   return std::abs(half) > flat(i) && std::abs(turn_[i] - half) < within * std::abs(more);
}

/// Finds vertices between an arc and a straight flank that no curve of the file marks. The
/// flank is straight if the next vertex does not turn, or is the joint of another arc. At a
/// corner or an end this cannot be checked, so only arcs of circles fit there.
void OpenSide::find_joints()
{
   std::vector<int> found(joint_.size(), 0);
   for (int i = 1; i < last(); ++i)
   {
      for (const int way : {-1, 1})
      {
         const int next = i - way;
         const bool fits =
            tells(next) ? fits_flank(i, way) &&
                             (std::abs(turn_[next]) <= flat(next) || fits_flank(next, -way))
                        : fits_flank(i, way, 1e-3);
         if (fits) { found[i] = way; }
      }
   }
   joint_ = found;
}

/// From the curvature of circles through the vertices at its ends.
EdgeBend OpenSide::bend(int e) const
{
   if (joint_[e] < 0 || joint_[e + 1] > 0) { return {}; } // a flank
   const int i = e, j = e + 1;
   const double middle = 0.5 * (along_[i] + along_[j]), h = length_[e];
   const auto slope = [&](int a, int b)
   { return (curvature_[b] - curvature_[a]) / (centre_[b] - centre_[a]); };
   double at = 0, change = 0;
   const bool from_left = tells(i), from_right = tells(j);
   const bool left = from_left && tells(i - 1), right = from_right && tells(j + 1);
   const auto one_sided = [&](int near, int far, bool both)
   {
      at = curvature_[near];
      if (!both) { return; }
      const double s = slope(std::min(near, far), std::max(near, far)),
                   there = at + s * (middle - centre_[near]);
      // Never reversed nor doubled, as the curve would then not go on.
      if (there * at < 0 || std::abs(there) > 2 * std::abs(at)) { return; }
      at = there;
      change = s;
   };
   if (from_left && from_right)
   {
      const double across = slope(i, j);
      const double before = left ? slope(i - 1, i) : HUGE_VAL,
                   after = right ? slope(j, j + 1) : HUGE_VAL;
      // At a jump of the curvature only one side is used.
      if (std::min(std::abs(before), std::abs(after)) < 0.3 * std::abs(across))
      {
         if (std::abs(before) < std::abs(after)) { one_sided(i, i - 1, true); }
         else { one_sided(j, j + 1, true); }
      }
      else
      {
         change = across;
         at = curvature_[i] + across * (middle - centre_[i]);
      }
   }
   else if (from_left) { one_sided(i, i - 1, left); }
   else if (from_right) { one_sided(j, j + 1, right); }
   const double half = arc(e, at), more = change * h * h / 12;
   return {half - more, half + more};
}

/// Makes the curves of neighbours have one tangent where they meet smoothly.
void OpenSide::meet(std::vector<EdgeBend> &all) const
{
   for (int i = 1; i < last(); ++i)
   {
      EdgeBend &before = all[i - 1], &after = all[i];
      // The tangent of an arc at its joint is the flank's.
      if (joint_[i] < 0) { before.end = turn_[i]; }
      if (joint_[i] > 0) { after.begin = turn_[i]; }
      if (!tells(i)) { continue; }
      const double missing = turn_[i] - before.end - after.begin;
      if (std::abs(missing) > 0.5 * std::abs(turn_[i])) { continue; }
      const double share = length_[i - 1] / (length_[i - 1] + length_[i]);
      before.end += share * missing;
      after.begin += (1 - share) * missing;
   }
}

/// Corners, and joints between arcs and flanks.
void OpenSide::classify()
{
   measure();
   join_curves();
   if (!find_corners())
   {
      std::fill(curve_.begin(), curve_.end(), -1);
      joined_.assign(x_.size(), false);
      find_corners();
   }
   distinct_ = corner_;
   find_short_runs();
   drop_profile();
   find_short_runs(); // of the edges that are not part of a profile
   find_joints();
}

std::vector<EdgeBend> OpenSide::all_bends() const
{
   std::vector<EdgeBend> found;
   for (int e = 0; e < last(); ++e) { found.push_back(bend(e)); }
   meet(found);
   return found;
}

/// Bends of the side's own edges, if they are more than round-off.
std::vector<EdgeBend> OpenSide::of_edges(const std::vector<EdgeBend> &all) const
{
   std::vector<EdgeBend> own(edges_);
   for (std::size_t k = 0; k < edges_; ++k)
   {
      const EdgeBend &its = all[first_ + k];
      if (std::max(std::abs(its.begin), std::abs(its.end)) > round_off) { own[k] = its; }
   }
   return own;
}

std::vector<EdgeBend> OpenSide::bends()
{
   if (last() < 2) { return std::vector<EdgeBend>(edges_); }
   classify();
   return of_edges(all_bends());
}

bool OpenSide::meets_image(bool end) const
{
   const int tip = tip_[end], step = end ? -1 : 1;
   if (tip < 0 || last() < 2) { return true; }
   if (corner_[tip]) { return false; }
   const int near = tip + step, far = near + step;
   // A flank between the tip and an arc must be normal to the plane.
   if (joint_[near] != 0) { return std::abs(turn_[tip]) <= flat(tip); }
   if (!tells(near)) { return true; }
   // The turn at the tip if the curvature beside it continues, constantly or linearly.
   const int edge = end ? tip - 1 : tip;
   const double alike = 2 * arc(edge, curvature_[near]);
   double linear = alike;
   if (tells(far))
   {
      const double change =
         (curvature_[far] - curvature_[near]) / (centre_[far] - centre_[near]);
      linear = 2 * arc(edge, curvature_[near] + change * (along_[tip] - centre_[near]));
   }
   return std::abs(turn_[tip] - linear) <=
          0.1 * std::abs(alike) + std::abs(linear - alike) + round_off;
}

std::vector<EdgeBend> OpenSide::possible() const
{
   std::vector<EdgeBend> own(edges_);
   if (last() < 2) { return own; }
   const auto kept = [&](int i)
   { return i > 0 && i < last() && corner_[i] && !distinct_[i] && !inside(i) && !parts(i); };
   const auto goes_on = [&](int i) // from i - 1
   {
      const double a = curvature_[i - 1], b = curvature_[i];
      return kept(i) && a * b > 0 &&
             std::max(std::abs(a), std::abs(b)) <= 2 * std::min(std::abs(a), std::abs(b));
   };
   const auto ends = [&](int i)
   {
      return i == 0 || i == last() ||
             (distinct_[i] && std::abs(turn_[i]) > SidePolygon::corner * degree);
   };
   OpenSide released = *this;
   std::vector<bool> may(last(), false); // of edges
   for (int begin = 1, end = 1; begin < last(); begin = end)
   {
      end = begin + 1;
      if (!kept(begin)) { continue; }
      while (end < last() && goes_on(end)) { ++end; }
      // Two turns are a chamfer. They are a curve only if they are all the turns between two
      // corners and the edges are about equally long.
      const auto first = length_.begin() + begin - 1, beyond = length_.begin() + end;
      const bool alone =
         ends(begin - 1) && ends(end) &&
         *std::max_element(first, beyond) <= 1.5 * *std::min_element(first, beyond);
      if (end - begin < 3 && !(end - begin == 2 && alone)) { continue; }
      for (int i = begin; i < end; ++i) { released.corner_[i] = false; }
      const int from = ends(begin - 1) ? begin - 1 : begin, to = ends(end) ? end : end - 1;
      for (int e = from; e < to; ++e) { may[e] = curve_[e] < 0; }
   }
   released.find_joints();
   own = of_edges(released.all_bends());
   for (std::size_t k = 0; k < edges_; ++k)
   {
      if (!may[first_ + k]) { own[k] = {}; }
   }
   return own;
}

/// A side with its bends, without images that it does not meet smoothly.
OpenSide settled(SidePolygon side)
{
   OpenSide open(side);
   open.bends();
   const std::array<bool, 2> meets{open.meets_image(false), open.meets_image(true)};
   if (meets[0] && meets[1]) { return open; }
   for (const std::size_t end : {0, 1})
   {
      if (!meets[end]) { side.beyond[end].setZero(); }
   }
   return OpenSide(side);
}

} // namespace

double EdgeBend::off(double s) const
{
   // The curve is the arc of a circle with the mean of both angles, plus an asymmetric cubic.
   const double mean = 0.5 * (begin + end), sine = std::sin(mean);
   const double arc = 2 * sine * s * (1 - s) /
                      (std::sqrt(1 - 4 * sine * sine * (s - 0.5) * (s - 0.5)) + std::cos(mean));
   return arc + 0.5 * (std::tan(begin) - std::tan(end)) * s * (1 - s) * (1 - 2 * s);
}

double EdgeBend::slope(double s) const
{
   const double mean = 0.5 * (begin + end), sine = std::sin(mean), from = s - 0.5;
   const double arc = -2 * sine * from / std::sqrt(1 - 4 * sine * sine * from * from);
   return arc + 0.5 * (std::tan(begin) - std::tan(end)) * (1 - 6 * s * (1 - s));
}

std::vector<EdgeBend> smooth_curve(const SidePolygon &side)
{
   return side.vertices.size() < 2 ? std::vector<EdgeBend>() : settled(side).bends();
}

std::vector<EdgeBend> possible_curve(const SidePolygon &side)
{
   if (side.vertices.size() < 2) { return {}; }
   OpenSide open = settled(side);
   open.bends();
   return open.possible();
}

} // namespace cattaneo

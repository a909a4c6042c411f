#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/pairing.hpp>
#include <cmath>
#include <limits>
#include <sstream>

namespace cattaneo
{

namespace
{

std::string listed(const ContactLine &line, const std::vector<bool> &matched)
{
   std::ostringstream text;
   text.precision(10);
   int count = 0;
   const int shown = 8;
   for (Eigen::Index i = 0; i < line.size(); ++i)
   {
      if (matched[i] || ++count > shown) { continue; }
      text << (count > 1 ? ", " : "") << "(" << line.position(i, 0) << ", "
           << line.position(i, 1) << ")";
   }
   if (count > shown) { text << " … and " << count - shown << " more"; }
   return count ? text.str() : "none";
}

} // namespace

Pairing pair_lines(const ContactLine &line1, const ContactLine &line2, double tolerance)
{
   require(tolerance > 0 && tolerance < 0.5, "pairing: tolerance is ", tolerance,
           ", must be above 0 and below 0.5 (edge lengths)");
   const Eigen::Index n1 = line1.size(), n2 = line2.size();
   Pairing pairing;
   pairing.partner.assign(n1, -1);
   pairing.gap = Eigen::VectorXd::Zero(n1);
   std::vector<bool> matched1(n1, false), matched2(n2, false);
   bool complete = n1 == n2;
   for (Eigen::Index i = 0; i < n1; ++i)
   {
      double nearest = std::numeric_limits<double>::infinity();
      Eigen::Index partner = -1;
      for (Eigen::Index j = 0; j < n2; ++j)
      {
         const double dx = line1.position(i, 0) - line2.position(j, 0);
         const double dy = line1.position(i, 1) - line2.position(j, 1);
         const double distance = dx * dx + dy * dy;
         if (distance >= nearest) { continue; }
         const double tx = line1.tangent(i, 0) - line2.tangent(j, 0);
         const double ty = line1.tangent(i, 1) - line2.tangent(j, 1);
         const double square = tx * tx + ty * ty; // 4 for exactly opposite lines
         const double offset = dx * tx + dy * ty; // times the length of (tx, ty)
         const double allowed = tolerance * std::min(line1.spacing[i], line2.spacing[j]);
         if (square < 2 || offset * offset > allowed * allowed * square) { continue; }
         nearest = distance;
         partner = j;
      }
      if (partner < 0 || matched2[partner])
      {
         complete = false;
         continue;
      }
      matched1[i] = matched2[partner] = true;
      pairing.partner[i] = static_cast<int>(partner);
      const double gap =
         (line1.position.row(i) - line2.position.row(partner)).dot(line1.normal.row(i));
      pairing.gap[i] = std::abs(gap) > 1e-9 * line1.spacing[i] ? gap : 0.0;
   }
   require(complete, "pairing: contact nodes without a partner within ", tolerance,
           " edge lengths; of body 1 (", n1, " nodes): ", listed(line1, matched1),
           "; of body 2 (", n2, " nodes): ", listed(line2, matched2));
   return pairing;
}

} // namespace cattaneo

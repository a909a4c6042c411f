#include <Eigen/SparseCholesky>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/halfplane/half_plane_field.hpp>
#include <cattaneo/halfplane/surface.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Displacement and stress at a point by the tractions q and p of the whole surface. x is along
/// the tangent, y along the normal.
struct Sums
{
   double ux = 0, uy = 0, xx = 0, yy = 0, xy = 0;
};

/// Coefficients of functions whose moments with the functions are the forces.
VectorXd tractions(const Eigen::SparseMatrix<double> &mass, const VectorXd &forces,
                   const std::vector<int> &kept)
{
   const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(kept_of(mass, kept));
   VectorXd result = VectorXd::Zero(forces.size());
   const VectorXd solved = factor.solve(VectorXd(forces(kept)));
   result(kept) = solved;
   return result;
}

} // namespace

struct HalfPlaneField::Tractions
{
   HalfPlane body;
   Surface surface;
   SurfaceTrace trace;
   VectorXd q, p;
   double length, bulk;

   Tractions(const HalfPlane &half_plane, const ContactLine &line, const VectorXd &forces,
             double along)
      : body(half_plane), surface(body, line), trace(trace_of(line, surface)), bulk(along)
   {
      const Index n = line.size();
      const Eigen::SparseMatrix<double> mass = trace.mass([](double) { return 1.0; });
      std::vector<int> all, sliding;
      for (int i = 0; i < n; ++i)
      {
         all.push_back(i);
         const bool on_plane =
            body.is_symmetric() && surface.along(line.nodes[i].position) == 0;
         if (!on_plane) { sliding.push_back(i); }
      }
      q = tractions(mass, forces.head(n) / body.thickness, sliding);
      p = tractions(mass, forces.tail(n) / body.thickness, all);
      const SurfaceElement &first = trace.elements().front(), &last = trace.elements().back();
      length = last.x[last.order()] - first.x[0];
   }

   /** Flamant's solutions for a pressure p and a shear q along x (Timoshenko and Goodier, art.
       36), relative to the point at the depth D below the force, with A = 2/πE', B = 2β/π, C =
       1/2πG, ξ = x - s, r² = ξ² + y² and tan θ = ξ/y:

          u_x = q (A ln D/r + C ξ²/r²) + p (C ξy/r² - B θ)
          u_y = p (A ln D/r - C ξ²/r²) + q (C ξy/r² + B θ)
          σ_xx, τ_xy, σ_yy = -2 (p y + q ξ)/(π r⁴) · (ξ², ξy, y²) */
   void add(Sums &sums, double x, double y, const SurfaceElement &element, double from,
            double to) const
   {
      const SurfacePoints ends = trace.points(element, Vector2d(from, to));
      const double low = element.x[0] + ends.x[0], high = element.x[0] + ends.x[1],
                   distance = std::hypot(std::max({low - x, x - high, 0.0}), y);
      if (distance < 0.5 * (high - low))
      {
         const double middle = 0.5 * (from + to);
         add(sums, x, y, element, from, middle);
         add(sums, x, y, element, middle, to);
         return;
      }
      const double A = 2 / (M_PI * body.material.plane_modulus()),
                   B = 0.5 / (M_PI * (body.material.lambda() + body.material.mu())),
                   C = 0.5 / (M_PI * body.material.mu());
      const QuadratureRule &rule = gauss_rule(static_cast<int>(element.order()) + 26);
      const VectorXd t = from + (to - from) * rule.points.array();
      const SurfacePoints at = trace.points(element, t);
      const VectorXd own_q = at.phi.transpose() * q(element.unknowns),
                     own_p = at.phi.transpose() * p(element.unknowns);
      for (Index k = 0; k < t.size(); ++k)
      {
         const double weight = (to - from) * rule.weights[k] * at.dx[k];
         const double qs = weight * own_q[k], ps = weight * own_p[k];
         const double xi = x - element.x[0] - at.x[k], r2 = xi * xi + y * y;
         const double ln = A * std::log(body.depth / std::sqrt(r2)), theta = std::atan2(xi, y),
                      across = C * xi * xi / r2, mixed = C * xi * y / r2;
         sums.ux += qs * (ln + across) + ps * (mixed - B * theta);
         sums.uy += ps * (ln - across) + qs * (mixed + B * theta);
         const double radial = -2 * (ps * y + qs * xi) / (M_PI * r2 * r2);
         sums.xx += radial * xi * xi;
         sums.xy += radial * xi * y;
         sums.yy += radial * y * y;
      }
   }

   Sums sums(double x, double y) const
   {
      Sums all;
      for (const SurfaceElement &element : trace.elements()) { add(all, x, y, element, 0, 1); }
      return all;
   }
};

HalfPlaneField::HalfPlaneField(const HalfPlane &body, const ContactLine &line,
                               const VectorXd &forces, double bulk)
{
   require(
      line.formulation == Formulation::plane,
      "field of a half-plane: its contact line is axisymmetric or of torsion, must be plane");
   body.validate(line.formulation);
   line.validate();
   require(forces.size() == 2 * line.size() && forces.allFinite(),
           "field of a half-plane: there are ", forces.size(),
           " forces, must be finite and two for each of the ", line.size(), " nodes");
   require(std::isfinite(bulk), "field of a half-plane: the bulk stress is ", bulk,
           ", must be finite");
   tractions_ = std::make_unique<Tractions>(body, line, forces, bulk);
}

HalfPlaneField::~HalfPlaneField() = default;

HalfPlaneField::Point HalfPlaneField::at(const Vector2d &position) const
{
   const HalfPlane &body = tractions_->body;
   const Vector2d t = tangent(body), &n = body.normal, from = position - body.point;
   const double surface = 1e-9 * tractions_->length, x = from.dot(t),
                y = std::max(from.dot(n), surface);
   require(from.dot(n) >= -surface, "field of a half-plane: the point ", position,
           " is above its surface, must be on or below it");
   Sums s = tractions_->sums(x, y);
   if (body.is_symmetric()) // its mirror image
   {
      const Sums other = tractions_->sums(-x, y);
      s = {s.ux - other.ux, s.uy + other.uy, s.xx + other.xx, s.yy + other.yy, s.xy - other.xy};
   }
   // The bulk stress strains the half-plane along the surface, and contracts it across by
   // Poisson's ratio, in plane strain by ν/(1-ν).
   const double nu = body.material.poisson,
                along = tractions_->bulk * body.bulk_strain(Formulation::plane);
   s.xx += tractions_->bulk;
   s.ux += along * x;
   s.uy -= along * y * (body.material.state == PlaneState::strain ? nu / (1 - nu) : nu);
   const Eigen::Matrix2d stress = s.xx * t * t.transpose() + s.yy * n * n.transpose() +
                                  s.xy * (t * n.transpose() + n * t.transpose());
   return {s.ux * t + s.uy * n, stress(0, 0), stress(1, 1), stress(0, 1)};
}

} // namespace cattaneo

#include <cattaneo/halfplane/flexibility.hpp>
#include <cattaneo/halfplane/kernel_integrals.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;

double one(double)
{
   return 1;
}

/// [tangential coupling; couplingᵀ normal], whose diagonal blocks are symmetric.
Flexibility joined(const MatrixXd &tangential, const MatrixXd &coupling, const MatrixXd &normal)
{
   const Index n = normal.rows();
   Flexibility F(2 * n, 2 * n);
   F.topLeftCorner(n, n) = tangential;
   F.topRightCorner(n, n) = coupling;
   F.bottomRightCorner(n, n) = normal;
   F.triangularView<Eigen::StrictlyLower>() = F.transpose();
   return F;
}

} // namespace

Flexibility plane_flexibility(const SurfaceTrace &trace, const Material &material, double depth,
                              bool symmetric)
{
   const SurfaceElement &first = trace.elements().front(), &last = trace.elements().back();
   const double from = first.x[0], to = last.x[last.order()];
   require(!symmetric || from >= 0 || to <= 0, "half-plane: the contact line from ", from,
           " to ", to,
           " along the surface crosses the plane of symmetry at 0, must lie on one side of it");
   const double length = symmetric ? 2 * std::max(-from, to) : to - from;
   require(std::isfinite(depth) && depth >= 2 * length,
           "half-plane: the depth to which its displacements are relative is ", depth,
           ", must be given, and be at least twice the length of the contact",
           symmetric ? " with its mirror image" : "", ", ", 2 * length,
           " (under given forces the contact does not depend on it)");

   const double below = material.plane_modulus() / (4 * material.mu());
   MatrixXd direct = -kernel_integrals(trace, trace, logarithm());
   const Eigen::VectorXd all = trace.integral(one);
   const MatrixXd together = all * all.transpose(), order = trace.ordered_integral(one, one);
   MatrixXd normal = direct + (std::log(depth) - below) * together, tangential,
            sign = order - order.transpose();
   if (symmetric)
   {
      const MatrixXd image = -kernel_integrals(trace, trace.mirrored(), logarithm());
      tangential = direct - image;
      normal += image + (std::log(depth) - below) * together;
      sign += (from >= 0 ? 1 : -1) * together;
   }
   else { tangential = direct + (std::log(depth) + below) * together; }
   const double scale = 2 / (M_PI * material.plane_modulus());
   const double beta = 0.25 / (material.lambda() + material.mu());
   return joined(scale * tangential, -beta * sign, scale * normal);
}

Flexibility axisymmetric_flexibility(const SurfaceTrace &trace, const RingIntegrals &rings,
                                     const Material &material, double side)
{
   const double round = 2 * M_PI, scale = round * (1 - material.poisson) / material.mu();
   // ∫∫ φ_i (p s / r) φ_j ds 2πr dr over s < r
   const MatrixXd inside = trace.ordered_integral(one, [](double s) { return s; });
   const double beta = round * (0.5 - material.poisson) / material.mu();
   return joined(scale * rings.odd, side * beta * inside, scale * rings.even);
}

Flexibility torsion_flexibility(const RingIntegrals &rings, const Material &material)
{
   return 2 * M_PI / material.mu() * rings.levered;
}

} // namespace cattaneo

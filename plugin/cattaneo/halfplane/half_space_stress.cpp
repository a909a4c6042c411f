#include <array>
#include <cattaneo/halfplane/half_space.hpp>
#include <cattaneo/halfplane/polygon_integrals.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

// Love's potentials of uniform tractions on a polygon. With R the distance of a point inside
// from one of the surface, φ = ln(R + z) and Ω = z ln(R + z) - R = ∫ φ dz are harmonic.
// Derivatives along the surface of their integrals over a polygon are integrals along its edges
// (divergence theorem), which antiderivatives at the ends of the edges give. Stresses need no
// more than these.

namespace cattaneo
{

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace
{

using Matrix3 = Eigen::Matrix<MoreDigits, 3, 3>;
using Vector3 = Eigen::Matrix<MoreDigits, 3, 1>;

/// ln(R + t) with a² = R² - t², without loss of digits for t < 0.
MoreDigits log_sum(MoreDigits R, MoreDigits t, MoreDigits a_squared)
{
   return t < 0 ? std::log(a_squared / (R - t)) : std::log(R + t);
}
/// 1/(R + t) in the same way.
MoreDigits inverse_sum(MoreDigits R, MoreDigits t, MoreDigits a_squared)
{
   return t < 0 ? (R - t) / a_squared : 1 / (R + t);
}
/// ∫ s/(R (R + z)) dt
MoreDigits angle(MoreDigits s, MoreDigits t, MoreDigits z, MoreDigits R)
{
   return s == 0 ? 0 : std::atan(t / s) - std::atan(z * t / (s * R));
}

enum Axis
{
   along_x,
   along_y,
   along_z
};

/// Antiderivatives, along an edge, of derivatives of the potentials, at one of its ends. The
/// axes are across the edge (s), along it (t), and z.
struct EdgeEnd
{
   Vector3 phi_first;
   Matrix3 phi_second, omega_second;

   EdgeEnd(MoreDigits s, MoreDigits t, MoreDigits z)
   {
      const MoreDigits R = std::sqrt(s * s + t * t + z * z), rest = s * s + z * z,
                       log_t = log_sum(R, t, rest), by_t = inverse_sum(R, t, rest),
                       by_z = 1 / (R + z);
      phi_first << angle(s, t, z, R), std::log(R + z), log_t;
      // The trace of the second derivatives (xx + yy + zz) is zero, because both potentials are
      // harmonic.
      const MoreDigits tt = t / R * by_z, zz = z / R * by_t, st = s / R * by_z,
                       sz = s / R * by_t, tz = 1 / R;
      phi_second << -tt - zz, st, sz, st, tt, tz, sz, tz, zz;
      // As ∂Ω/∂z = φ, derivatives along z are known from φ.
      omega_second << t * by_z - log_t, -s * by_z, 0, -s * by_z, -t * by_z, 0, 0, 0, 0;
   }
};

/// Derivatives of the potentials' integrals over a polygon, at a point.
struct PotentialDerivatives
{
   using Third = std::array<Matrix3d, 3>; ///< one matrix for each first axis
   Matrix3d phi_second = Matrix3d::Zero();
   Third phi_third{Matrix3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero()};
   Third omega_third{Matrix3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero()};

   /// @a point: z >= 0.
   PotentialDerivatives(const Polygon &polygon, const Vector3d &point)
   {
      Matrix3 phi_2 = Matrix3::Zero();
      std::array<Matrix3, 2> phi_3{phi_2, phi_2}, omega_3{phi_2, phi_2};
      for (std::size_t k = 0; k < polygon.size(); ++k)
      {
         Vector3 from = point.cast<MoreDigits>(), to = from;
         from.head(2) -= polygon[k].cast<MoreDigits>();
         to.head(2) -= polygon[(k + 1) % polygon.size()].cast<MoreDigits>();
         const Vector3 along = (from - to).normalized(), normal(along[1], -along[0], 0);
         Matrix3 axes;
         axes << normal, along, Vector3::UnitZ();
         const MoreDigits s = normal.dot(from);
         const EdgeEnd first(s, along.dot(from), from[2]), last(s, along.dot(to), to[2]);
         phi_2 += normal * (axes * (last.phi_first - first.phi_first)).transpose();
         const Matrix3 phi = axes * (last.phi_second - first.phi_second) * axes.transpose(),
                       omega =
                          axes * (last.omega_second - first.omega_second) * axes.transpose();
         for (const std::size_t i : {0, 1})
         {
            phi_3[i] += normal[static_cast<Index>(i)] * phi;
            omega_3[i] += normal[static_cast<Index>(i)] * omega;
         }
      }
      close(phi_2, phi_3, omega_3);
   }

private:
   /// Derivatives whose first axis is z follow from the others: their order does not matter,
   /// both potentials are harmonic, and ∂Ω/∂z = φ.
   void close(Matrix3 phi_2, const std::array<Matrix3, 2> &phi_3,
              const std::array<Matrix3, 2> &omega_3)
   {
      phi_2.row(along_z) << phi_2(along_x, along_z), phi_2(along_y, along_z),
         -phi_2(along_x, along_x) - phi_2(along_y, along_y);
      phi_second = phi_2.cast<double>();
      const Matrix3 &x = phi_3[along_x], &y = phi_3[along_y];
      Matrix3 z;
      z << x(along_z, along_x), x(along_z, along_y), x(along_z, along_z), //
         y(along_z, along_x), y(along_z, along_y), y(along_z, along_z),   //
         x(along_z, along_z), y(along_z, along_z), -x(along_x, along_z) - y(along_y, along_z);
      phi_third[along_x] = x.cast<double>();
      phi_third[along_y] = y.cast<double>();
      phi_third[along_z] = z.cast<double>();
      for (const std::size_t i : {along_x, along_y})
      {
         omega_third[i] = omega_3[i].cast<double>();
         omega_third[i].row(along_z) = omega_third[i].col(along_z).transpose() =
            phi_second.row(static_cast<Index>(i));
      }
      omega_third[along_z] = phi_second;
   }
};

/// Stress of a half-space z >= 0 under uniform tractions {q; p} on a polygon of its surface.
Matrix3d stress(const Material &material, const Polygon &polygon, const Vector3d &point,
                const Vector3d &traction)
{
   const PotentialDerivatives I(polygon, point);
   const double nu = material.poisson, z = point[2];
   // [Love 1929], [Johnson 1985] 3.9: 4πG u = 2 ∂(F, G)/∂z - grad H + 2ν grad ψ1 - z grad ψ
   // along the surface, ∂H/∂z + (1 - 2ν) ψ - z ∂ψ/∂z along z. F, G, H are φ times the
   // tractions.
   Matrix3d psi_one = Matrix3d::Zero(), psi_second = Matrix3d::Zero();
   for (Index k = 0; k < 3; ++k)
   {
      psi_one += traction[k] * I.omega_third[static_cast<std::size_t>(k)];
      psi_second += traction[k] * I.phi_third[static_cast<std::size_t>(k)];
   }
   const Vector3d psi = I.phi_second * traction;
   Matrix3d gradient = -z * psi_second; // ∂u_i/∂x_j in row i
   gradient.col(along_z) -= psi;        // of z itself
   for (const int i : {along_x, along_y})
   {
      gradient.row(i) += 2 * traction[i] * I.phi_second.row(along_z) -
                         traction[along_z] * I.phi_second.row(i) + 2 * nu * psi_one.row(i);
   }
   gradient.row(along_z) +=
      traction[along_z] * I.phi_second.row(along_z) + (1 - 2 * nu) * psi.transpose();
   // In units of 1/4πG, which is the shear modulus of the stress. As the potentials are
   // harmonic the volume changes by 2 (1 - 2ν) ∂ψ/∂z, of which Lamé's other modulus makes 4ν.
   return (4 * nu * psi[along_z] * Matrix3d::Identity() + gradient + gradient.transpose()) /
          (4 * M_PI);
}

} // namespace

Eigen::Matrix<double, Eigen::Dynamic, 6>
HalfSpace::stresses(const Eigen::MatrixX3d &points, const Eigen::VectorXd &forces) const
{
   validate();
   const Index n = nodes();
   require(forces.size() == 3 * n, "half-space: ", forces.size(), " nodal forces, must be ",
           3 * n, ", three for each cell");
   require(forces.allFinite(), "half-space: a nodal force is not finite");
   require(points.allFinite(), "half-space: a point has an entry that is not finite");
   const std::vector<Polygon> cells = polygons_of(*this);
   const Eigen::MatrixX3d tractions = areas().cwiseInverse().asDiagonal() *
                                      Eigen::Map<const Eigen::MatrixX3d>(forces.data(), n, 3);
   Eigen::Matrix<double, Eigen::Dynamic, 6> result(points.rows(), 6);
   for (Index i = 0; i < points.rows(); ++i)
   {
      const bool above = points(i, 2) >= 0;
      require(above || other, "half-space: the point at z = ", points(i, 2),
              " lies in the body below, which is rigid and has no stresses, must lie in the "
              "body above");
      // Seen from the body below, z is mirrored and shear changes its sign.
      const Vector3d side(1, 1, above ? 1 : -1), sign(above ? 1 : -1, above ? 1 : -1, 1);
      Matrix3d sum = Matrix3d::Zero();
      for (Index j = 0; j < n; ++j)
      {
         if (tractions.row(j).isZero(0)) { continue; }
         sum += stress(above ? material : *other, cells[static_cast<std::size_t>(j)],
                       points.row(i).transpose().cwiseProduct(side),
                       sign.cwiseProduct(tractions.row(j).transpose()));
      }
      sum = (side.asDiagonal() * sum * side.asDiagonal()).eval();
      result.row(i) << sum(0, 0), sum(1, 1), sum(2, 2), sum(1, 2), sum(2, 0), sum(0, 1);
   }
   return result;
}

} // namespace cattaneo

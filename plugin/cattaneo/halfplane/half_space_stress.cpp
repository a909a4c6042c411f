#include <array>
#include <cattaneo/halfplane/half_space.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

// Love's potentials of uniform tractions on a rectangle. With R the distance of a point inside
// from one of the surface, φ = ln(R + z) and Ω = z ln(R + z) - R = ∫ φ dz are harmonic. Their
// integrals over a rectangle are differences between its corners, and so are the derivatives
// that stresses need.

namespace cattaneo
{

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace
{

/// More digits, because the four corners cancel far away from the rectangle.
using Digits = long double;

/// ln(R + t) where a² = R² - t², which keeps its digits for t < 0.
Digits log_sum(Digits R, Digits t, Digits a_squared)
{
   return t < 0 ? std::log(a_squared / (R - t)) : std::log(R + t);
}
/// 1/(R + t) likewise.
Digits inverse_sum(Digits R, Digits t, Digits a_squared)
{
   return t < 0 ? (R - t) / a_squared : 1 / (R + t);
}
/// ∫ s/(R (R + z)) dt
Digits angle(Digits s, Digits t, Digits z, Digits R)
{
   return s == 0 ? 0 : std::atan(t / s) - std::atan(z * t / (s * R));
}

enum Axis
{
   along_x,
   along_y,
   along_z
};

/// Derivatives of the potentials' integrals over a rectangle, at a point.
struct PotentialDerivatives
{
   using Third = std::array<Matrix3d, 3>; ///< one matrix for each first axis
   Matrix3d phi_second = Matrix3d::Zero();
   Third phi_third{Matrix3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero()};
   Third omega_third{Matrix3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero()};

   /// @a way: from the centre of the rectangle to the point, z >= 0.
   PotentialDerivatives(const Eigen::Vector2d &size, const Vector3d &way)
   {
      for (const int right : {-1, 1})
      {
         for (const int upper : {-1, 1})
         {
            add_corner(way[0] + right * static_cast<Digits>(size[0]) / 2,
                       way[1] + upper * static_cast<Digits>(size[1]) / 2, way[2],
                       right * upper);
         }
      }
      close();
   }

private:
   /// What the corners tell: the rest follows.
   struct Sums
   {
      Digits xx = 0, yy = 0, xy = 0, xz = 0, yz = 0;                        ///< of φ
      Digits xxy = 0, xyy = 0, xyz = 0, xxz = 0, yyz = 0, xzz = 0, yzz = 0; ///< of φ
      Digits omega_xxx = 0, omega_xxy = 0, omega_xyy = 0, omega_yyy = 0;    ///< of Ω
   };
   Sums sums_;

   void add_corner(Digits s, Digits t, Digits z, int sign)
   {
      const Digits R = std::sqrt(s * s + t * t + z * z), r_s = t * t + z * z,
                   r_t = s * s + z * z;
      const Digits log_s = log_sum(R, s, r_s), log_t = log_sum(R, t, r_t),
                   by_s = inverse_sum(R, s, r_s), by_t = inverse_sum(R, t, r_t),
                   by_z = 1 / (R + z);
      sums_.xx += sign * angle(s, t, z, R);
      sums_.yy += sign * angle(t, s, z, R);
      sums_.xy += sign * std::log(R + z);
      sums_.xz += sign * log_t;
      sums_.yz += sign * log_s;
      sums_.xxy += sign * s / R * by_z;
      sums_.xyy += sign * t / R * by_z;
      sums_.xyz += sign / R;
      sums_.xxz += sign * s / R * by_t;
      sums_.yyz += sign * t / R * by_s;
      sums_.xzz += sign * z / R * by_t;
      sums_.yzz += sign * z / R * by_s;
      sums_.omega_xxx += sign * (t * by_z - log_t);
      sums_.omega_xxy -= sign * s * by_z;
      sums_.omega_xyy -= sign * t * by_z;
      sums_.omega_yyy += sign * (s * by_z - log_s);
   }

   static void set(Third &third, Digits value, int i, int j, int k)
   {
      const auto entry = static_cast<double>(value);
      for (const auto &[a, b, c] :
           {std::array<int, 3>{i, j, k}, {i, k, j}, {j, i, k}, {j, k, i}, {k, i, j}, {k, j, i}})
      {
         third[static_cast<std::size_t>(a)](b, c) = entry;
      }
   }

   /// The sums over the axes twice are zero, as both potentials are harmonic, and ∂Ω/∂z = φ.
   void close()
   {
      const Sums &I = sums_;
      const auto symmetric = [&](int i, int j, Digits value)
      { phi_second(i, j) = phi_second(j, i) = static_cast<double>(value); };
      symmetric(along_x, along_x, I.xx);
      symmetric(along_y, along_y, I.yy);
      symmetric(along_z, along_z, -I.xx - I.yy);
      symmetric(along_x, along_y, I.xy);
      symmetric(along_x, along_z, I.xz);
      symmetric(along_y, along_z, I.yz);
      set(phi_third, -I.xyy - I.xzz, along_x, along_x, along_x);
      set(phi_third, I.xxy, along_x, along_x, along_y);
      set(phi_third, I.xyy, along_x, along_y, along_y);
      set(phi_third, -I.xxy - I.yzz, along_y, along_y, along_y);
      set(phi_third, I.xyz, along_x, along_y, along_z);
      set(phi_third, I.xxz, along_x, along_x, along_z);
      set(phi_third, I.yyz, along_y, along_y, along_z);
      set(phi_third, I.xzz, along_x, along_z, along_z);
      set(phi_third, I.yzz, along_y, along_z, along_z);
      set(phi_third, -I.xxz - I.yyz, along_z, along_z, along_z);
      set(omega_third, I.omega_xxx, along_x, along_x, along_x);
      set(omega_third, I.omega_xxy, along_x, along_x, along_y);
      set(omega_third, I.omega_xyy, along_x, along_y, along_y);
      set(omega_third, I.omega_yyy, along_y, along_y, along_y);
      for (int i = 0; i < 3; ++i)
      {
         for (int j = 0; j < 3; ++j) { set(omega_third, phi_second(i, j), i, j, along_z); }
      }
   }
};

/// Stress of a half-space z >= 0 under uniform tractions {q; p} on a rectangle of its surface.
Matrix3d stress(const Material &material, const Eigen::Vector2d &size, const Vector3d &way,
                const Vector3d &traction)
{
   const PotentialDerivatives I(size, way);
   const double nu = material.poisson, z = way[2];
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
   const Index n = centres.rows();
   require(forces.size() == 3 * n, "half-space: ", forces.size(), " nodal forces, must be ",
           3 * n, ", three for each rectangle");
   require(forces.allFinite(), "half-space: a nodal force is not finite");
   require(points.allFinite(), "half-space: a point has an entry that is not finite");
   const Eigen::MatrixX3d tractions =
      Eigen::Map<const Eigen::MatrixX3d>(forces.data(), n, 3) / size.prod();
   Eigen::Matrix<double, Eigen::Dynamic, 6> result(points.rows(), 6);
   for (Index i = 0; i < points.rows(); ++i)
   {
      const bool above = points(i, 2) >= 0;
      require(above || other, "half-space: the point at z = ", points(i, 2),
              " lies in the body below, which is rigid");
      // Seen from the body below, z is mirrored and shear is the opposite one.
      const Vector3d side(1, 1, above ? 1 : -1), sign(above ? 1 : -1, above ? 1 : -1, 1);
      Matrix3d sum = Matrix3d::Zero();
      for (Index j = 0; j < n; ++j)
      {
         if (tractions.row(j).isZero(0)) { continue; }
         Vector3d way = points.row(i);
         way.head(2) -= centres.row(j);
         sum += stress(above ? material : *other, size, way.cwiseProduct(side),
                       sign.cwiseProduct(tractions.row(j).transpose()));
      }
      sum = (side.asDiagonal() * sum * side.asDiagonal()).eval();
      result.row(i) << sum(0, 0), sum(1, 1), sum(2, 2), sum(1, 2), sum(2, 0), sum(0, 1);
   }
   return result;
}

} // namespace cattaneo

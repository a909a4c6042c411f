#pragma once

#include <Eigen/Dense>
#include <array>
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/exchange/nodal_stiffness.hpp>
#include <cattaneo/friction/contact_state.hpp>
#include <functional>
#include <string>
#include <vector>

/// Blocks of cells in space and in the plane, whose stiffness is assembled here.
namespace cattaneo_test
{

/// Which solids a block is made of: every cell one hexahedron, two wedges, or six tetrahedra.
enum class Solid
{
   hexahedra,
   wedges,
   tetrahedra
};

/** A block of cells, at `from`, with sets BOTTOM (least y), TOP and SIDES (least and largest
   z), and turned about the origin after that. Axes of a block that is not turned: x along, y
   up, z through the thickness. */
cattaneo::NodalStiffness
block(std::array<int, 3> cells, const Eigen::Vector3d &from, const Eigen::Vector3d &size,
      double E, double nu, Solid solid = Solid::hexahedra,
      const Eigen::Matrix3d &turn = Eigen::Matrix3d::Identity(), int order = 1,
      const std::function<Eigen::Vector3d(const Eigen::Vector3d &)> &bend = {});

/// The plane block of the same cells.
cattaneo::NodalStiffness plane_block(int nx, int ny, const Eigen::Vector3d &from,
                                     const Eigen::Vector3d &size, double E, double nu);

/// Condensed on the contact surface, or line, of a set of nodes.
cattaneo::CondensedBody on_surface(const cattaneo::NodalStiffness &body,
                                   const std::string &set);
cattaneo::CondensedBody on_line(const cattaneo::NodalStiffness &body, const std::string &set);

/// States at the ends of increments from loads to loads, which must all converge.
std::vector<cattaneo::ContactState> solved(cattaneo::ReducedProblem problem, double friction,
                                           const std::vector<Eigen::VectorXd> &loads);

/// The forces of a problem whose single increment goes to loads of 1.
cattaneo::ContactState pressed(const cattaneo::ReducedProblem &problem, double friction);

/// A turn about none of the axes.
extern const Eigen::Matrix3d askew;

} // namespace cattaneo_test

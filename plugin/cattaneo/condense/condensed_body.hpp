#pragma once

#include <cattaneo/condense/contact_line.hpp>
#include <cattaneo/condense/contact_surface.hpp>
#include <cattaneo/counters.hpp>
#include <cattaneo/load_pattern.hpp>
#include <memory>

namespace cattaneo
{

/// Computes displacements of the whole body from those of its contact nodes. All in global
/// components.
class BodySolver
{
public:
   virtual ~BodySolver() = default;
   /// Displacements of all dofs (only those of this rank, if the body is on several) from
   /// displacements of the contact dofs and load multipliers.
   virtual Eigen::VectorXd recover(const Eigen::VectorXd &contact,
                                   const Eigen::VectorXd &multipliers,
                                   Counters &counters) const = 0;
   /// CondensedBody::error_estimate() of the stiffness S, which does not resist `motions`.
   virtual double error(const Eigen::MatrixXd &S, const Eigen::MatrixXd &motions,
                        Counters &counters) const = 0;
};

/** One body reduced to its contact nodes (thesis 3.2):  f = S u + Σ ℓ_k f_k, in the local
    frames of the contact line: u = {v; w}, f = {q; p}, all tangential entries first.

    In a torsion body u = v = u_θ and f = q are circumferential, positive in the direction of
    the twist whatever the line's frames. In space u = {v₁; v₂; w} in the frames of the surface:
    all first tangents, all second ones, then the normals.

    Only the matrix of the program that assembled the body is kept. */
class CondensedBody
{
public:
   std::string name;            ///< name of the body in messages; may be empty
   ContactLine line;            ///< its contact nodes, in their order; none in space
   ContactSurface surface = {}; ///< in space: its contact nodes, else none
   /// 2n × 2n (torsion: n × n, in space 3n × 3n), symmetric; zero in the rows and columns that
   /// are held.
   Eigen::MatrixXd S;
   /// Rows of S of components that supports hold, increasing. A node with one held component
   /// keeps the frame of the line, at any angle to that component. With v held the node moves
   /// across the held direction. Then w is its opening along the normal of the line, and p the
   /// force along that normal, part of which the support carries. See directions().
   std::vector<int> held;
   /// Thickness of a plane body. All forces are those of this thickness. See thicken().
   double thickness = 1;
   /// Prescribed displacements of held components per unit multiplier: {x; y} of all contact
   /// nodes, 2n × patterns, in space {x; y; z} of their unknowns, 3n × patterns. Zero
   /// elsewhere. Empty if no load moves a held component.
   Eigen::MatrixXd moved;
   std::vector<LoadPattern> patterns; ///< f_k, by name (torsion: p is empty)
   Eigen::MatrixXd H;   ///< loads by loads with the contact clamped (see ReducedProblem::H)
   int rigid_modes = 0; ///< rigid motions that the supports leave free (0 to 3; in space 0 to
                        ///< 6; 0 or 1 about an axis)
   /// The motions of the contact nodes that neither supports nor stiffness resist, in local
   /// frames: rows of S × k, orthonormal columns. S does not resist them to round-off.
   Eigen::MatrixXd free_motions;
   Counters counters; ///< of condensing it and of all later recoveries

   /// Displacement of all dofs (only those of this rank, if the body is on several) for contact
   /// displacements {v; w} of *this body* and load multipliers (order of `patterns`).
   /// Displacements of held components are ignored. Costs one solve with the kept factor.
   Eigen::VectorXd recover(const Eigen::VectorXd &u, const Eigen::VectorXd &multipliers);

   /** Relative error of S, an upper estimate from the energies of its solves. (For a body
       condensed by conjugate gradients: from the difference of S u and the action of the
       operator, in double precision.) Materials or elements of great contrast within one body
       cost digits: 1e-3 means that stiffnesses, and displacements under given forces, have an
       error of 0.1 %. Infinite: for some motion no digit is correct. Costs a few solves with
       the kept factor. Collective. */
   double error_estimate();

   /// Multiplies the thickness of a plane body, and with it S, H and the forces of patterns.
   /// Where two bodies touch, the area in a pressure is that of the thinner one. InputError for
   /// an axisymmetric body, or unless the factor is positive and finite.
   void thicken(double times);

   /// Number of contact nodes.
   Eigen::Index nodes() const { return S.rows() / components(line.formulation); }
   /// n × 3, places of the contact nodes; z is 0 except in space.
   Eigen::MatrixX3d places() const;

   /// The rigid motions of the contact nodes in local frames: plane 2n × 3 (x, y, rotation
   /// about `centre`), in space 3n × 6 (x, y, z, rotations about axes through `centre`),
   /// axisymmetric 2n × 1 (z), torsion n × 1 (rotation).
   Eigen::MatrixXd rigid_motions(const Eigen::Vector3d &centre = {0, 0, 0}) const;

   /// Displacements in x and y of a node for v = 1 and for w = 1, as columns: its tangent and
   /// its normal, unless supports hold one of its components. In space 3 × 3: its tangents and
   /// its normal.
   Eigen::MatrixXd directions(Eigen::Index node) const;
   /// Do supports hold a component (0: x or r, 1: y or z, in space 2: z) of a node? Not for
   /// torsion.
   bool holds(Eigen::Index node, int component) const;
   /// Does a load move a component (0: x or r, 1: y or z, in space 2: z) of a node?
   bool moves(Eigen::Index node, int component) const;

   std::shared_ptr<const BodySolver> solver; ///< of the free components; shared by copies

private:
   /// Positions in {x; y} (in space {x; y; z}) of all nodes of the components that are free.
   std::vector<int> free_positions() const;
};

} // namespace cattaneo

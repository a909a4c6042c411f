#pragma once

#include <array>
#include <cattaneo/condense/assembled_body.hpp>
#include <cattaneo/counters.hpp>
#include <cattaneo/elastic/boundary_part.hpp>
#include <cattaneo/elastic/field.hpp>
#include <cattaneo/elastic/guide.hpp>
#include <cattaneo/elastic/stress.hpp>
#include <cattaneo/formulation.hpp>
#include <cattaneo/mesh/ranks.hpp>
#include <cattaneo/scalar_field.hpp>
#include <functional>
#include <memory>
#include <mfem.hpp>
#include <optional>
#include <string>
#include <vector>

namespace cattaneo
{

/// A user's stress at a point of a body (the transformation's) that moves by `displacement`
/// under these load multipliers, by the names of the patterns.
using StressLaw =
   std::function<Stress(const mfem::GridFunction &displacement, mfem::ElementTransformation &at,
                        const NamedLoads &loads)>;

/** One elastic body: its stiffness on the true dofs of an H1 space, its supports and its load
    patterns. Knows nothing of contact.

    The stiffness is *not* eliminated: reactions and prescribed displacements need all of it.
    The space is the nodal Gauss–Lobatto one, ordered byVDIM or byNODES: other bases have edge
    weights of both signs, or dofs that are no nodal values, and are refused.

    Plane: components 0 = x, 1 = y, forces per unit thickness. Axisymmetric: x = r and y = z,
    components 0 = r, 1 = z, forces on the whole circumference; u_r = 0 on the axis holds by
    itself. Torsion: the same mesh, but the one component is the twist ψ = u_θ/r: fixed or
    prescribed values are angles, and the forces of a pattern are torques. The two decouple, so
    a body that twists is an axisymmetric and a torsion body. With both, r < 0 is an InputError.

    Space: components 0 = x, 1 = y, 2 = z. A mesh of dimension 3 makes a body in space; its
    formulation need not be named. Hexahedra, tetrahedra and wedges, conforming, on one rank.

    Everything that is named by a BoundaryPart throws InputError if the attribute does not exist
    or nothing lies in the interval.

    On an mfem::ParMesh every call is collective, dofs are those that the rank
    owns, and the stiffness is a hypre matrix. */
class ElasticBody
{
public:
   /// Assembles the isotropic operator on elements of the given order (>= 1). The mesh must
   /// outlive the body: straight, curved and nonconforming (not if distributed) meshes of quads
   /// and triangles, or solids as above.
   ElasticBody(mfem::Mesh &mesh, int order, const Material &material,
               Formulation formulation = Formulation::plane);

   /// One material for each element attribute (index attribute - 1), no more and no less.
   ElasticBody(mfem::Mesh &mesh, int order, const std::vector<Material> &materials,
               Formulation formulation = Formulation::plane);

   /// Young's modulus and Poisson's ratio that vary: numbers, functions of (x, y), in space of
   /// (x, y, z), or coefficients of MFEM, which must outlive the body. They must be in the
   /// ranges of Material (InputError that names the point).
   ElasticBody(mfem::Mesh &mesh, int order, Field young, Field poisson,
               Formulation formulation = Formulation::plane,
               PlaneState state = PlaneState::strain);

   /// The user's own symmetric operator on the true dofs of an H1 space of 2 components, in
   /// torsion 1, in space 3 (orthotropic, user integrators, …). Copies the matrix; the space
   /// must outlive the body. Nothing is eliminated from the matrix: condense() refuses to
   /// displace dofs whose rows have only a diagonal.
   ElasticBody(mfem::FiniteElementSpace &space, const mfem::SparseMatrix &stiffness,
               Formulation formulation = Formulation::plane);

   /// A body can be moved, not copied.
   ElasticBody(ElasticBody &&) = default;
   /// A body can be moved, not copied.
   ElasticBody &operator=(ElasticBody &&) = default;

   /// No displacement of this component on the nodes of a boundary part. In torsion edges on
   /// the axis are left out, because the axis may twist.
   void fix(const BoundaryPart &part, int component);
   /// No displacement of this component at the node of the space nearest to (x, y).
   void fix_node(double x, double y, int component);
   /// The same of a body in space, nearest to (x, y, z).
   void fix_node(double x, double y, double z, int component);
   /// No displacement at these true dofs of the space (of this rank), as
   /// mfem::FiniteElementSpace::GetEssentialTrueDofs lists them. InputError for a number that
   /// is no true dof or is listed twice, as in a boundary marker (use fix(marker, component)
   /// for that).
   void fix(const mfem::Array<int> &true_dofs);

   /// Forces on the true dofs of the space (of this rank), in axisymmetry on the whole
   /// circumference, in torsion torques. For loads that the other functions do not cover.
   /// InputError if the size is wrong or a force is not finite.
   void add_forces(const std::string &pattern, const mfem::Vector &forces);
   /// Forces of an assembled linear form on the body's own space.
   void add_forces(const std::string &pattern, const mfem::LinearForm &form);
   /** An isotropic strain that the material takes without stress, such as α ΔT: the pattern
       gets the forces ∫ σ₀ : ε(v), σ₀ = D ε₀, at the points where the stiffness is integrated,
       and stresses are D (ε - ℓ ε₀), ℓ the pattern's multiplier. In plane strain and
       axisymmetry it is a strain in all three directions. stress_at evaluates it again, so a
       coefficient must outlive the body. InputError for a user's operator and for torsion. */
   void add_initial_strain(const std::string &pattern, const Field &strain);
   /// The same for a tensor {xx, yy, xy, zz} (in axisymmetry {rr, zz, rz, θθ}), xy half of the
   /// angle, the last out of the plane. InputError in space.
   void add_initial_strain(const std::string &pattern, const std::array<Field, 4> &strain);
   /// The same for any symmetric 3 × 3 tensor, in the order x, y and z, or out of the plane (r,
   /// z and θ in axisymmetry); except in space without shear out of the plane (InputError).
   void add_initial_strain(const std::string &pattern, mfem::MatrixCoefficient &strain);

   /// Pressure on a boundary part (positive pushes into the body), force per area.
   void add_pressure(const std::string &pattern, const BoundaryPart &part, const Field &p);
   /// Traction (t_x, t_y) on a boundary part, force per area.
   void add_traction(const std::string &pattern, const BoundaryPart &part, const Field &tx,
                     const Field &ty);
   /// Traction (t_x, t_y, t_z) on a boundary part of a body in space, force per area.
   void add_traction(const std::string &pattern, const BoundaryPart &part, const Field &tx,
                     const Field &ty, const Field &tz);
   /// A boundary part on which loads act, cut at the ends of its interval.
   struct Extent
   {
      double size = 0;                 ///< its length; about an axis and in space its area
      Eigen::Vector3d middle{0, 0, 0}; ///< mean place of its points, (r, z, 0) about an axis
   };
   /// InputError if the mesh has no such part; of size 0 if an interval leaves nothing of it.
   /// @param called what the part is called in an error
   Extent extent(const BoundaryPart &part, const std::string &called = "extent") const;
   /// Circumferential traction t_θ on a boundary part of a torsion body, force per area.
   void add_traction(const std::string &pattern, const BoundaryPart &part, const Field &t);
   /// Body force (b_x, b_y), force per volume.
   void add_body_force(const std::string &pattern, const Field &bx, const Field &by);
   /// Body force (b_x, b_y, b_z) of a body in space, force per volume.
   void add_body_force(const std::string &pattern, const Field &bx, const Field &by,
                       const Field &bz);
   /// Prescribed displacement of one component on the nodes of a boundary part. A pattern is
   /// either force- or displacement-controlled (InputError if mixed); a node's displacement may
   /// be prescribed by several patterns (they add) and need not be fixed as well. Within one
   /// pattern parts may share nodes, on which they must agree (InputError otherwise).
   void add_displacement(const std::string &pattern, const BoundaryPart &part, int component,
                         const ScalarField &u);
   /// The same for all components, from a grid function on the body's own space
   /// (mfem::GridFunction::ProjectCoefficient, ProjectBdrCoefficient, …).
   void add_displacement(const std::string &pattern, const BoundaryPart &part,
                         const mfem::GridFunction &u);

   /** A part that moves as a rigid block. Its loads are patterns like all others, and may act
       on other parts too. InputError if a node of the part is held, moved or guided already,
       for a load without a name, for a torsion body, and in axisymmetry for any motion except
       that along the axis. Not for a body on several ranks. */
   void guide(const BoundaryPart &part, const Guide &guide);
   /// Motions of guides that are free or under forces.
   const std::vector<BlockMotion> &blocks() const { return blocks_; }

   /// The law by which stress_at and the output of fields compute stresses, mainly for a user's
   /// operator. InputError for torsion.
   void set_stress(StressLaw law);

   /// Plane, axisymmetric, torsion or space.
   Formulation formulation() const { return formulation_; }
   /// Unknowns of each node: 2, in torsion 1, in space 3.
   int components() const { return cattaneo::components(formulation_); }
   /// The space of its displacements: the user's, or one made here from the order.
   mfem::FiniteElementSpace &space() const { return *space_; }
   /// The ranks that share its mesh.
   const Ranks &ranks() const { return ranks_; }
   /// True dofs of all ranks.
   int dofs() const;
   /// The stiffness of a body that is not distributed.
   const mfem::SparseMatrix &stiffness() const { return *stiffness_; }
   /// The same matrix, to be kept beyond the life of the body (never changed).
   SharedMatrix shared_stiffness() const;
   /// Load patterns, values on the true dofs of this rank.
   const std::vector<BodyLoad> &patterns() const { return patterns_; }
   /// Sorted true dofs that are fixed or prescribed by a displacement pattern.
   mfem::Array<int> essential_dofs() const;
   /// Sorted true dofs of this rank whose displacement this pattern prescribes, also as 0; none
   /// of a pattern of forces.
   std::vector<int> prescribed_dofs(const std::string &pattern) const;
   /// Material of an element attribute; InputError for a user's operator and for one that
   /// varies.
   const Material &material(int attribute) const;
   /// Material at the point that is set in an element's transformation.
   Material material(mfem::ElementTransformation &at) const;
   /// False for a user's operator.
   bool has_material() const { return varying_ || !materials_.empty(); }
   /// The law of set_stress(), or empty.
   const StressLaw &stress_law() const { return stress_law_; }
   /// Whether stress_at() can compute stresses.
   bool has_stress() const { return has_material() || stress_law_; }
   /// The sum of the initial strains of all patterns, at the point that is set. InputError if a
   /// pattern that has one is not among the loads.
   Strain initial_strain(mfem::ElementTransformation &at, const NamedLoads &loads) const;

   /// True dof of component c of the scalar node (local dof) of the space, -1 if it depends on
   /// others (nonconforming meshes) or belongs to another rank.
   int true_dof(int scalar_dof, int component) const;
   /// The same as a number that all ranks share.
   int global_dof(int scalar_dof, int component) const;
   /// First of the global numbers of this rank's true dofs.
   int first_global_dof() const { return first_global_dof_; }
   /// Coordinates of every scalar node, size 2 × nodes, in space 3 × nodes.
   const mfem::DenseMatrix &node_coordinates() const { return coordinates_; }
   /// The place of a scalar node; z is 0 but in space.
   Eigen::Vector3d place(int scalar_dof) const;
   /// The box around all nodes, of all ranks; z is 0 but in space.
   Eigen::AlignedBox3d box() const;
   /// True if a scalar node lies on the axis of revolution; always false in the plane.
   bool on_axis(int scalar_dof) const;

   /// Counts of the work so far.
   const Counters &counters() const { return counters_; }

private:
   void make_space(mfem::Mesh &mesh, int order);
   void check_space() const;
   void adopt_space();
   void assemble();
   void hold_axis();
   void check_component(const std::string &where, int component) const;
   void fix_node_at(const Eigen::Vector3d &point, int component);
   /// InputError unless a load of that many components is one for this body.
   void check_given(const std::string &where, int given) const;
   BodyLoad &load(const std::string &name, Control control);
   void add_to_pattern(const std::string &name, const mfem::Vector &local_forces);
   using StrainField = std::function<Strain(mfem::ElementTransformation &)>;
   struct PointLoad;
   template <class Density>
   void add_volume_load(const std::string &pattern, bool at_points_of_stiffness,
                        Density density);
   void add_strain_field(const std::string &pattern, StrainField strain);
   void prescribe(const std::string &pattern, int node, int component, double value);
   template <class Density>
   void add_boundary_load(const std::string &pattern, const BoundaryPart &part,
                          const char *what, Density density);
   template <class Density>
   void add_face_load(const std::string &pattern, const BoundaryPart &part, const char *what,
                      Density density);
   void add_body_force(const std::string &pattern, const std::vector<const Field *> &force);
   std::vector<int> nodes_on(const BoundaryPart &part, const std::string &where) const;

   std::unique_ptr<mfem::FiniteElementCollection> owned_collection_;
   std::unique_ptr<mfem::FiniteElementSpace> owned_space_;
   mfem::FiniteElementSpace *space_ = nullptr;
   Formulation formulation_ = Formulation::plane;
   double axis_radius_ = 0.0; ///< nodes nearer to the axis than this are on it
   Ranks ranks_;
   int first_global_dof_ = 0;
   std::shared_ptr<const mfem::SparseMatrix> stiffness_;
   std::vector<Material> materials_;
   std::optional<VaryingMaterial> varying_;
   StressLaw stress_law_;
   struct InitialStrain
   {
      std::string pattern;
      StrainField at;
   };
   std::vector<InitialStrain> initial_strains_;
   std::vector<BodyLoad> patterns_;
   std::vector<BlockMotion> blocks_;
   std::vector<std::vector<bool>>
      prescribed_;               ///< by pattern and true dof (empty: force control)
   std::vector<bool> essential_; ///< by true dof
   std::vector<int> vdof_to_true_;
   mfem::DenseMatrix coordinates_;
   Counters counters_;

   // Last, because clang-format takes what follows a directive apart.
#ifdef MFEM_USE_MPI
public:
   /// A user's operator on several ranks, nothing eliminated from it either.
   ElasticBody(mfem::ParFiniteElementSpace &space, const mfem::HypreParMatrix &stiffness,
               Formulation formulation = Formulation::plane);
   /// The stiffness of a distributed body, which may be kept beyond its life.
   std::shared_ptr<const mfem::HypreParMatrix> distributed_stiffness() const;

private:
   std::shared_ptr<const mfem::HypreParMatrix> distributed_;
#endif
};

} // namespace cattaneo

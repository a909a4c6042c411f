#pragma once

#include <cattaneo/condense/condensed_body.hpp>
#include <cattaneo/reduced/pairing.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <cattaneo/scalar_field.hpp>
#include <optional>

namespace cattaneo
{

struct Interface;
struct UnionRows;
struct ContactMotions;

/// The data of an interface in a reduction.
struct InterfaceReport
{
   std::string name; ///< that it was given
   std::array<int, 2> bodies{0,
                             -1}; ///< the body that has the nodes, and the body that faces them
   Eigen::Index first = 0; ///< first of its nodes of the problem; tied: among the tied ones
   Eigen::Index nodes = 0; ///< number of them
   bool tied = false;      ///< its nodes are not in the problem
   /// True: the nodes are those of Interface::second, and forces on the first body are
   /// opposite.
   bool of_second = false;
   /// n × 2, places of the nodes of a line. Those of a surface are in ReducedProblem::position;
   /// this member and the members for lines after it are then empty.
   Eigen::MatrixX2d position;
   Eigen::MatrixX2d outline; ///< n × 2, ContactLine::outline: where gaps are measured from
   Eigen::MatrixX2d tangent; ///< n × 2, of their frames: unit vectors
   /// In space n × 9, of the nodes: the first tangent, the second one, the normal into the body
   /// that has them.
   Eigen::MatrixXd frames = {};
   Eigen::MatrixX3d places = {}; ///< in space n × 3, of the nodes
   /// In space: places of nodes without a row, because other rows join them to the body
   /// opposite.
   std::vector<Eigen::Vector3d> in_rings = {};
   /// n × 2 each: the places where the nodes' forces act on the body that has the nodes, and on
   /// the body that faces it. The first is the node's own place, except on an element that is
   /// faced in part. The second lies on the other side of a gap.
   std::array<Eigen::MatrixX2d, 2> acts_at;
   Eigen::VectorXd weights; ///< of the nodes, see LineNode
   Eigen::VectorXd spacing; ///< of the nodes, see LineNode
   bool matching = false;   ///< its nodes are also the other body's
   /// Places of nodes of the slave that nothing faces, and of those that are faced but carry no
   /// row: tips, nodes that are another interface's, those that close a ring of interfaces,
   /// ends that supports hold in both components.
   std::vector<Eigen::Vector2d> free_surface = {}; ///< nodes of the slave that nothing faces
   std::vector<Eigen::Vector2d> without_row = {};  ///< see above
   double left_out = 0;                            ///< Mortar::left_out
   /// n, Mortar::chords: the error of the gap, if it follows from the geometry; 0 if the
   /// elements of both sides match.
   Eigen::VectorXd chords = {};
   Eigen::VectorXd curved = {}; ///< n, Mortar::curved; 0 in the same case
   double arm = 0; ///< largest size of Mortar::arm: moment left by a normal force of 1
   /// n: the angle between the normals of both bodies at each node, in radians, 0 where they
   /// are opposite. The frame of the node is the mean of both. 0 on a rigid obstacle.
   Eigen::VectorXd turn = {};
   /// A place where a Pairing pairs nodes one to one although an element of the one body has no
   /// equal on the other (differing_element()); none: there is no such place. Tractions are
   /// wrong there.
   std::optional<Eigen::Vector2d> differing = {};
   /// A node of the problem that a load moves along the interface, by a prescribed
   /// displacement, while the body opposite is at rest or is moved otherwise. Its slip is that
   /// of the load: its v is held at 0 in the problem, and its law of friction is left out.
   struct Moved
   {
      Eigen::Index node = 0; ///< of the problem
      int pattern = 0;       ///< among those of the problem
   };
   std::vector<Moved> moved = {}; ///< see Moved
};

/// A rigid obstacle moves (or deforms) by (ux, uy) per unit multiplier, functions of the
/// contact nodes' places, in axisymmetry (ur, uz), in space (ux, uy, uz); with torsion also by
/// u_θ along the circumference. (0, 1) moves it up; (c - y, x) turns it about (0, c).
struct ObstacleMotion
{
   std::size_t interface = 0; ///< in Reduction::interfaces
   ScalarField ux = 0.0;      ///< along x or r
   ScalarField uy = 0.0;      ///< along y or z
   ScalarField u_theta = 0.0; ///< along the circumference
   ScalarField uz = 0.0;      ///< in space along z
};

/** A reduced problem together with the way back to the fields of its bodies. Load patterns of
    the bodies are joined by name; the friction coefficient is zero until set. Nodes of one
    body, or of two whose nodes match, are those of body 1's contact line, in its order and
    frames; of interfaces those of each one's slave, one after the other.

    Torsion is a third block that is there only if it is added: it decouples in the bulk, so
    that A = diag(A_r, A_θ) and B = (B_r, 0), and friction alone couples it to the rest. */
class Reduction
{
public:
   ReducedProblem problem;                  ///< the problem to be solved
   std::vector<CondensedBody> bodies;       ///< as condensed, in the order given
   std::vector<InterfaceReport> interfaces; ///< in the order given
   std::vector<CondensedBody> torsion;      ///< the same bodies in torsion, or empty
   Counters counters;                       ///< sum over the bodies and all later recoveries

   /** Adds the circumferential components of axisymmetric bodies (their torsion bodies, in the
       same order, each condensed to the same nodes): for one body v_θ = u_θ, and q_θ is the
       force on it, positive along the twist. For several bodies v_θ is u_θ of the body that has
       the nodes less u_θ of the facing body, and q_θ is the force on the former. At nodes that
       do not match u_θ is interpolated like u_r, so that a rotation about the axis is exact.
       Load patterns of the same name are one pattern. InputError unless the reduction is of as
       many axisymmetric bodies without torsion, if nodes differ, or if in a union over
       interfaces a contact node is held around the axis. */
   void add_torsion(std::vector<CondensedBody> twisting);
   /// The same for one body, or for two.
   void add_torsion(CondensedBody body1, std::optional<CondensedBody> body2 = std::nullopt);

   /** A load pattern that moves rigid obstacles, each that of one interface. Displacements of
       the reduced problem are relative to them; gaps and normals stay as they are (the motion
       is linearised), and the conjugate of the pattern is the obstacles' reaction. Shanks must
       have been added before.

       A load of prescribed displacements with the same name becomes one load with it.

       InputError if the name is empty or that of a load of forces, if an interface is between
      two bodies or tied, if a displacement is not finite, or if it moves along a component that
      is held (a plane of symmetry). */
   void add_obstacle_motion(const std::string &name,
                            const std::vector<ObstacleMotion> &motions);
   /// The same for all obstacles of one body. The third displacement is along the
   /// circumference, in space along z.
   void add_obstacle_motion(const std::string &name, const ScalarField &ux,
                            const ScalarField &uy, const ScalarField &third = 0.0);

   /** Rigid obstacles that are free to move, in one motion or several, each that of some
       interfaces, and take loads there: obstacles on which forces or moments act, guided or
       not. Displacements of the reduced problem are relative to them, as of
       add_obstacle_motion(). The load of a motion is a force on the obstacles that does work
       `force` per unit multiplier and unit of the motion (a force along it, a moment about a
       turn's centre), and its conjugate is the motion, times `force`. A motion without a name
       has no load. Loads with one name are one load: those of motions here, and forces that
       exist already. Shanks must have been added before, prescribed motions after.

       InputError if a name is that of prescribed displacements, as of add_obstacle_motion(),
       if no motion is given, or if the bodies do not
       resist one of them. */
   struct FreeMotion
   {
      std::string load;                    ///< name of its pattern; empty: none
      double force = 1;                    ///< per unit multiplier
      std::vector<ObstacleMotion> motions; ///< of the interfaces' obstacles
   };
   /// See FreeMotion. Called once, with all motions of all obstacles that are free.
   void free_obstacles(const std::vector<FreeMotion> &motions);

   /** A shank, or another spring that pulls two parts of the bodies together. `pattern` is a
       load of equal and opposite forces on both parts, and becomes the pretension. With N the
       multiplier of the acting forces, T the multiplier of the pretension and g the pattern's
       conjugate (for forces that pull, the approach of the parts),

          N = T - stiffness · g.

       The conjugate of the pretension is g. Stiffness: force over displacement, of a pattern
       whose forces add up to 1 on either part; of F in their place stiffness / F². InputError
       unless the pattern is there and of forces, the stiffness positive and H known, or if an
       obstacle moves already. */
   void add_shank(const std::string &pattern, double stiffness);

   /** The nodal forces {q; p} that tied interfaces transfer, all tangential ones first, of
       their nodes in the order of the reports; displacements and multipliers as of
       displacement(). */
   Eigen::VectorXd tied_forces(const Eigen::VectorXd &v, const Eigen::VectorXd &w,
                               const Eigen::VectorXd &multipliers) const;

   /// The circumferential forces q_θ of the same nodes, for displacements v of twist().
   Eigen::VectorXd tied_twisting(const Eigen::VectorXd &v,
                                 const Eigen::VectorXd &multipliers) const;

   /** Forces of contact nodes and ties on body `b`, in x and y (r and z) on the nodes of its
       line, n × 2; in space forces in x, y and z on those of its surface, n × 3.
       @param q     tangential forces of the contact nodes; none without friction
       @param p     normal forces of the contact nodes
       @param tied  of tied_forces(); none where nothing is tied
       InputError if there is no such body, or for other sizes. */
   Eigen::MatrixXd contact_forces(int b, const Eigen::VectorXd &q, const Eigen::VectorXd &p,
                                  const Eigen::VectorXd &tied = {}) const;

   /** Torques of contact nodes and ties on body `b` around the axis, on the nodes of its line.
       @param q     circumferential forces of the contact nodes, the second component of q
       @param tied  of tied_twisting(); none where nothing is tied
       InputError if nothing twists, if there is no such body, or for other sizes. */
   Eigen::VectorXd contact_torques(int b, const Eigen::VectorXd &q,
                                   const Eigen::VectorXd &tied = {}) const;

   /// Displacement of all true dofs of body `b`, for relative displacements v (of all
   /// tangential components) and w of the contact nodes and multipliers of problem.patterns.
   /// One solve with that body's factor. If two free bodies can move together without
   /// resistance, this common motion is zero in the mean (least squares).
   Eigen::VectorXd displacement(int b, const Eigen::VectorXd &v, const Eigen::VectorXd &w,
                                const Eigen::VectorXd &multipliers);
   /// Twist ψ = u_θ/r of all true dofs of torsion body `b`, for the same displacements v.
   Eigen::VectorXd twist(int b, const Eigen::VectorXd &v, const Eigen::VectorXd &multipliers);

   /// How bodies share relative displacements.
   class Union
   {
   public:
      virtual ~Union() = default;
      /// Contact displacements of body `b` of those that were united, in its own order and
      /// frames.
      virtual Eigen::VectorXd own(const std::vector<CondensedBody> &bodies, int b,
                                  const Eigen::VectorXd &relative,
                                  const Eigen::VectorXd &multipliers) const = 0;
      /// Forces {q; p} of tied nodes.
      virtual Eigen::VectorXd tied(const Eigen::VectorXd &, const Eigen::VectorXd &) const
      {
         return {};
      }
   };
   /// Indices in problem.patterns of a body's patterns.
   using PatternIndex = std::vector<std::vector<int>>;

private:
   friend Reduction reduce(std::vector<CondensedBody> bodies,
                           const std::vector<Interface> &interfaces);
   friend ContactMotions contact_motions(const Reduction &reduction);
   /// Multipliers in which the forces of shanks replace their pretensions, for displacements
   /// {v; w} that include the obstacles'.
   Eigen::VectorXd acting(const Eigen::VectorXd &u, Eigen::VectorXd multipliers) const;
   /// {v; w} without the circumferential displacements.
   Eigen::VectorXd without_torsion(const Eigen::VectorXd &u) const;
   Eigen::VectorXd recover(CondensedBody &body, const Eigen::VectorXd &u,
                           const std::vector<int> &patterns,
                           const Eigen::VectorXd &multipliers);

   std::shared_ptr<const Union> union_, torsion_union_;
   std::shared_ptr<const UnionRows> rows_; ///< of all interfaces
   PatternIndex pattern_, torsion_pattern_;
   /// Displacements {v; w} of rigid obstacles at the contact nodes in these motions: one
   /// vector, zero beyond their interfaces. InputError, which begins with `where`.
   Eigen::VectorXd displaced(const std::string &where,
                             const std::vector<ObstacleMotion> &motions) const;
   /// Writes the displacements on one interface in space to their rows of `d`.
   void displace_in_space(const std::string &where, const ObstacleMotion &motion,
                          Eigen::VectorXd &d) const;
   /// Contribution of moving obstacles to the relative displacements {v; w} of the contact
   /// nodes.
   Eigen::VectorXd moved(const Eigen::VectorXd &u, const Eigen::VectorXd &multipliers) const;
   /// Displacements {v; w} of a rigid obstacle, one column per pattern of the problem; empty if
   /// it rests.
   Eigen::MatrixXd obstacle_;
   /// Of obstacles that are free: {v; w} of each motion, and how far it goes, by_load ·
   /// multipliers + by_contact · {v; w}; empty if there are none.
   Eigen::MatrixXd free_motions_, by_load_, by_contact_;
   /// The force of a shank is at_rest·multipliers + at_once·{v; w}.
   struct Shank
   {
      Eigen::Index pattern;
      Eigen::VectorXd at_rest, at_once;
   };
   std::vector<Shank> shanks_; ///< each for the problem with those before it
};

/** One body in space against a rigid obstacle, with the initial gap of each of its contact
   nodes (gaps_to_plane() and others): reduce(bodies, interfaces) with Interface::node_gaps.
    InputError for another number of gaps, one that is not finite, or if a normal component is
    held. */
Reduction reduce(CondensedBody body, const Eigen::VectorXd &gap);

/// One body against a rigid obstacle; gap as a function of the contact nodes' coordinates.
/// Tangential components that the body holds are ReducedProblem::held; InputError if a normal
/// one is.
Reduction reduce(CondensedBody body, const ScalarField &gap = 0.0);

/** Two bodies (thesis 3.3) with nodes one to one; by the symmetric formulas

       S = S1 - S1 (S1 + S2)⁻¹ S1,     f = f1 - S1 (S1 + S2)⁻¹ (f1 - f2);

    either or both may be free. It is reduce(bodies, interfaces) with the pairing as the only
    interface. Gap of the pairing, and of smooth curves that elements are chords of
    (ContactLine::off_curves()); it may be overwritten in the result. Frames (those of the
    interface's report) and weights of the nodes are the mean of both bodies'. A component that
    is held in one body only follows the other body; one that is held in both is held in the
    problem. InputError if both hold a normal one, if a common rigid motion of two free bodies
    is loaded, or if a pattern is force-controlled in one and displacement-controlled in the
    other. */
Reduction reduce(CondensedBody body1, CondensedBody body2, const Pairing &pairing);

} // namespace cattaneo

#pragma once

#include <Eigen/Sparse>
#include <cattaneo/condense/assembled_body.hpp>
#include <cattaneo/condense/condensed_body.hpp>
#include <map>
#include <string>
#include <vector>

namespace cattaneo
{

/// A row of another program's matrix.
struct NodeDof
{
   int node = 0;      ///< its number in that program
   int direction = 1; ///< 1: x (r about an axis), 2: y (z), 3 in space: z

   /// By node, then by direction.
   bool operator<(const NodeDof &other) const
   {
      return node < other.node || (node == other.node && direction < other.direction);
   }
};

/** The stiffness of one body or several, whose rows have nodes and directions as in
    finite-element programs. Every reader returns it, and supports, loads and contact lines are
    given by its node sets. You can also fill it from a matrix of your own.

    Forces are per unit thickness in the plane, of the whole circumference about an axis. In
    space each node has three directions, a place (x, y, z), and contact is on faces. Set names
    are found whatever their capitals. Arguments that are nodes may be nodes_of("TOP") or a
    list. InputError, with the file, the node and the direction, for data that do not fit. */
class NodalStiffness
{
public:
   /// By rows, both triangles.
   using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
   /// Numbers of nodes.
   using Nodes = std::vector<int>;
   /// Where each node is: (x, y), or (r, z).
   using Places = std::map<int, Eigen::Vector2d>;
   /// Nodes by the names of sets.
   using Sets = std::map<std::string, Nodes>;

   std::string name; ///< of the file; of a part, the set that is the part, or "body 1", …
   Formulation formulation = Formulation::plane; ///< plane, axisymmetric or space
   Matrix K;                                     ///< symmetric, both triangles
   std::vector<NodeDof> dofs;                    ///< of each row, each once
   Places places;                                ///< of each node: (x, y), or (r, z)
   Sets sets;                                    ///< names in capitals
   std::vector<int> fixed;                       ///< rows; sorted
   std::vector<BodyLoad> loads;                  ///< values by row
   /// Nodes of each outer edge of the body, along it with the body on the left. Empty if no
   /// elements are known, and in space.
   std::vector<Nodes> edges;
   std::map<int, double> z = {}; ///< in space: the third coordinate of each node
   /// In space: nodes of each outer face of the body, in their order around it. Empty if no
   /// elements are known.
   std::vector<Nodes> faces = {};
   /// The program that wrote K left out rows of supports, so that K resists motions, or
   /// eliminated them. Rows that have only their diagonal then count as fixed
   /// (AssembledBody::eliminated()).
   bool supports_left_out = false;
   Nodes on_springs; ///< from a deck: nodes with springs, which resist motions
   Matrix M = {};    ///< the mass, with the rows of K; without rows if it is not known

   /// Is there a set with this name (in any capitals)?
   bool has_set(const std::string &set) const;
   /// The nodes of a set; InputError with the names of all sets.
   const Nodes &nodes_of(const std::string &set) const;

   /// Holds a direction (1 or 2, in space 1 to 3) of nodes. Directions without a row in K are
   /// held already.
   void fix(const Nodes &nodes, int direction);
   /// Adds a force at each of the nodes to the load of that name, which is new or has force
   /// control.
   void add_forces(const std::string &load, const Nodes &nodes, int direction, double force);
   /// Moves nodes by a value per unit multiplier, and fixes them; a direction without a row in
   /// K, or whose row has only the diagonal (an eliminated support), cannot be moved.
   void add_displacement(const std::string &load, const Nodes &nodes, int direction,
                         double value);
   /// Force per length (area, about an axis) on the elements that contact_line() finds.
   void add_traction(const std::string &load, const Nodes &nodes,
                     const Eigen::Vector2d &traction, int order = 0);

   /// In space: force per area on the faces that contact_surface() finds.
   void add_surface_traction(const std::string &load, const Nodes &nodes,
                             const Eigen::Vector3d &traction);

   /// The load of that name, a new one of zeros if there is none; InputError if it has the
   /// other control.
   BodyLoad &load_of(const std::string &load, Control control);

   /** Bodies that are connected to nothing, by the lowest number of their nodes. Each gets its
       own rows, places, edges, supports, loads, and its part of the sets. Its name is that of
       the smallest set that has all of its nodes and none of another body, else "body 1", "body
       2", …. Bodies with nodes without rows, or on springs, count as having supports (if that
       is known); the others must be free (see body()). */
   std::vector<NodalStiffness> parts() const;

   /** The body for condense(), whose dofs are the rows. Nodes on an axis stay on it, with or
       without a support. InputError if nothing is fixed or left out and K resists a rigid
       motion by more than 1e-12 of its entries. */
   AssembledBody body() const;

   /** The trace on nodes, whose dofs are rows of K.

       order 0: on the outer edges all of whose nodes are among the given ones, in whatever
       order these are. order 1 to 8, where no elements are known: nodes are in order, the body
       on their left, elements of that order through them, each but its ends at the
       Gauss–Lobatto points (order 2: the middle); a loop names its first node again at the end.
       InputError if K shows that the body is on the right.

       Weights, tangents, ends and what happens on an axis are those of a contact line of
       MFEM. */
   ContactLine contact_line(const Nodes &nodes, int order = 0) const;

   /** In space: the trace on the outer faces all of whose nodes are among the given ones.
       InputError if no elements are known, or there is no such face. */
   ContactSurface contact_surface(const Nodes &nodes) const;
   /** The same on faces (surface_of()), which need not be outer faces of elements that are
       known. The side of the body follows from K. */
   ContactSurface contact_surface(const std::vector<Nodes> &on) const;

   /// (x, y, z) of a node; z is 0 except in space.
   Eigen::Vector3d place(int node) const;

   /// Number of each dof's row; InputError for a direction that does not exist, a second row of
   /// a dof, or a node without a place.
   std::map<NodeDof, int> rows() const;
   /// InputError unless rows, places, fixed rows and loads fit each other.
   void validate() const;

private:
   /// The row of each node in this direction, -1 if there is none and that is allowed.
   std::vector<int> rows_of(const Nodes &nodes, int direction, bool missing_allowed) const;
   double axis() const; ///< nodes at smaller r are on it
   /// Outer faces of nodes, as contact_surface() finds them.
   std::vector<Nodes> faces_on(const Nodes &nodes) const;
   /// Elements of a trace, as contact_line() finds them.
   std::vector<Nodes> elements_on(const Nodes &nodes, int order) const;
   /// InputError if K resists rigid motions.
   void require_free(const DofPlaces &at) const;
   void require_body_on_left(const ContactLine &line) const;
   /// The part that consists of these rows. `owner` is the group of each node that has rows.
   NodalStiffness part(const std::vector<int> &rows, const std::map<int, std::size_t> &owner,
                       std::size_t group) const;
};

/** A condensed body for another program: its stiffness in global components, {x; y} of node 1,
    of node 2, … along its contact line, and the contact forces of its loads turned into forces
    on that stiffness. Components that are held have no row. `sets` has one, "CONTACT".
    InputError for a body of torsion. */
NodalStiffness nodal_stiffness(const CondensedBody &body);

} // namespace cattaneo

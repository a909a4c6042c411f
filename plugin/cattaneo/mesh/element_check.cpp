#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cattaneo/algebra/dense_lu.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/element_check.hpp>
#include <cattaneo/mesh/ranks.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <vector>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Below this share of its largest value a determinant is zero.
constexpr double tolerance = 1e-10;

enum class Fault
{
   none,
   flat,   ///< no area
   turned, ///< negative determinant everywhere
   folded  ///< and positive elsewhere
};

/// Values at Chebyshev–Lobatto points of [0, 1], turned into Bernstein coefficients of that
/// degree.
struct Bernstein
{
   VectorXd points;
   MatrixXd of_values;

   explicit Bernstein(int degree) : points(degree + 1), of_values(degree + 1, degree + 1)
   {
      MatrixXd values(degree + 1, degree + 1);
      for (int k = 0; k <= degree; ++k)
      {
         const double x =
            degree ? 0.5 * (1 - std::cos(std::acos(-1.0) * k / static_cast<double>(degree)))
                   : 0.5;
         points[k] = x;
         double binomial = 1;
         for (int i = 0; i <= degree; ++i)
         {
            values(k, i) = binomial * std::pow(x, i) * std::pow(1 - x, degree - i);
            binomial *= static_cast<double>(degree - i) / (i + 1);
         }
      }
      DenseLU factors;
      factors.compute(values);
      of_values.setIdentity();
      factors.solve(of_values);
   }
};

/// Coefficients of a polynomial on the first and on the second half of its interval, one
/// polynomial a column (de Casteljau).
std::array<MatrixXd, 2> halves(MatrixXd c)
{
   const Index n = c.rows();
   std::array<MatrixXd, 2> half{c, c};
   for (Index level = 0; level < n; ++level)
   {
      half[0].row(level) = c.row(0);
      half[1].row(n - 1 - level) = c.row(n - 1 - level);
      for (Index i = 0; i + 1 < n - level; ++i) { c.row(i) = 0.5 * (c.row(i) + c.row(i + 1)); }
   }
   return half;
}

/// True if the polynomial of these Bernstein coefficients is above a level on the whole square.
bool above(const MatrixXd &c, double level, int depth = 10)
{
   if (c.minCoeff() > level) { return true; }
   const Index last = c.rows() - 1;
   const bool corners =
      c(0, 0) > level && c(last, 0) > level && c(0, last) > level && c(last, last) > level;
   if (!corners || depth == 0) { return false; }
   for (const MatrixXd &half : halves(c))
   {
      for (const MatrixXd &quarter : halves(half.transpose()))
      {
         if (!above(quarter, level, depth - 1)) { return false; }
      }
   }
   return true;
}

/// Data that elements of one shape share: the points where the determinant is sampled, and the
/// derivatives of the mapping there. The reference is the unit square. For a triangle its side
/// u = 1 is a point.
class Shape
{
public:
   explicit Shape(const mfem::FiniteElement &map)
      : bernstein_(degree(map)), by_xi_(map.GetDof(), samples()),
        by_eta_(map.GetDof(), samples())
   {
      mfem::DenseMatrix gradient(map.GetDof(), 2);
      const VectorXd &at = bernstein_.points;
      for (Index i = 0, k = 0; i < at.size(); ++i)
      {
         for (Index j = 0; j < at.size(); ++j, ++k)
         {
            mfem::IntegrationPoint ip;
            ip.Set2(at[i], triangle(map) ? at[j] * (1 - at[i]) : at[j]);
            map.CalcDShape(ip, gradient);
            for (int a = 0; a < map.GetDof(); ++a)
            {
               by_xi_(a, k) = gradient(a, 0);
               by_eta_(a, k) = gradient(a, 1);
            }
         }
      }
   }

   Fault fault(const mfem::DenseMatrix &nodes) const
   {
      const Eigen::Map<const MatrixXd> x(nodes.Data(), 2, nodes.Width());
      if (!x.allFinite()) { return Fault::none; } // for the message about the node
      const MatrixXd a = x * by_xi_, b = x * by_eta_;
      const VectorXd determinant =
         a.row(0).cwiseProduct(b.row(1)) - a.row(1).cwiseProduct(b.row(0));
      const double largest = determinant.cwiseAbs().maxCoeff();
      const double along = a.colwise().norm().maxCoeff(),
                   across = b.colwise().norm().maxCoeff();
      // Change of the determinant by the round-off of x and y.
      const auto extent = [&](Index c)
      { return a.row(c).cwiseAbs().maxCoeff() + b.row(c).cwiseAbs().maxCoeff(); };
      const double round_off = 8 * std::numeric_limits<double>::epsilon() *
                               (x.row(0).cwiseAbs().maxCoeff() * extent(1) +
                                x.row(1).cwiseAbs().maxCoeff() * extent(0));
      if (largest <= 1e-12 * along * across || largest <= round_off) { return Fault::flat; }
      const Index n = bernstein_.points.size();
      const MatrixXd c = bernstein_.of_values *
                         Eigen::Map<const MatrixXd>(determinant.data(), n, n) *
                         bernstein_.of_values.transpose();
      if (above(c, tolerance * largest)) { return Fault::none; }
      return above(-c, tolerance * largest) ? Fault::turned : Fault::folded;
   }

private:
   static bool triangle(const mfem::FiniteElement &map)
   {
      return map.GetGeomType() == mfem::Geometry::TRIANGLE;
   }
   /// Degree of the determinant in each direction, for polynomials of the map's order.
   static int degree(const mfem::FiniteElement &map)
   {
      return triangle(map) ? 2 * map.GetOrder() - 2 : 2 * map.GetOrder() - 1;
   }
   Index samples() const { return bernstein_.points.size() * bernstein_.points.size(); }

   Bernstein bernstein_;
   MatrixXd by_xi_, by_eta_; // nodes × samples
};

/// The shapes of a mesh, each made once.
class Shapes
{
public:
   explicit Shapes(mfem::Mesh &mesh) : mesh_(mesh) {}
   Fault fault(int element)
   {
      mesh_.GetElementTransformation(element, &transformation_);
      const mfem::FiniteElement &map = *transformation_.GetFE();
      auto &shape = shapes_[map.GetGeomType()];
      // For splines the shape functions depend on the element.
      if (!shape || mesh_.NURBSext) { shape = std::make_unique<Shape>(map); }
      return shape->fault(transformation_.GetPointMat());
   }

private:
   mfem::Mesh &mesh_;
   mfem::IsoparametricTransformation transformation_;
   std::array<std::unique_ptr<Shape>, mfem::Geometry::NUM_GEOMETRIES> shapes_;
};

/// The fault of an element, as numbers that ranks can exchange.
struct Place
{
   double number, attribute, x, y, z;
};

/// The mesh must be in space of two or three dimensions.
Place place(mfem::Mesh &mesh, int element)
{
   mfem::Vector centre(mesh.SpaceDimension());
   mesh.GetElementCenter(element, centre);
   double number = element;
#ifdef MFEM_USE_MPI
   if (const auto *shared = dynamic_cast<const mfem::ParMesh *>(&mesh))
   {
      number = static_cast<double>(shared->GetGlobalElementNum(element));
   }
#endif
   return {number, static_cast<double>(mesh.GetAttribute(element)), centre(0), centre(1),
           mesh.Dimension() == 3 ? centre(2) : std::numeric_limits<double>::quiet_NaN()};
}

std::string name(const double *place)
{
   std::ostringstream text;
   text << "element " << static_cast<long>(place[0]) << " (attribute " << place[1]
        << ", centre (" << place[2] << ", " << place[3];
   if (!std::isnan(place[4])) { text << ", " << place[4]; }
   text << "))";
   return text.str();
}

/// Sends the list of the first rank that has one to all ranks. Empty if no rank has one. All
/// lists have this length.
std::vector<double> first_of_all(const Ranks &ranks, const std::vector<double> &here,
                                 std::size_t length)
{
   std::vector<double> all = ranks.gather(here);
   all.resize(std::min(all.size(), length));
   return all;
}

void check_dimension(mfem::Mesh &mesh)
{
   const int dimension = mesh.Dimension(), space = mesh.SpaceDimension();
   if (dimension == space && (dimension == 2 || dimension == 3)) { return; }
   std::ostringstream which;
   if (dimension == 2 && space < 2)
   {
      // MFEM's readers drop a coordinate that is the same for all nodes.
      which << ": all of its nodes lie on one line, its elements have no thickness; nodes must "
               "differ in x and in y";
   }
   else if (dimension == 2 && mesh.GetNE() > 0)
   {
      // The element that is the farthest from the xy plane.
      int worst = 0;
      double farthest = -1, z = 0;
      mfem::Vector centre(space);
      for (int e = 0; e < mesh.GetNE(); ++e)
      {
         mesh.GetElementCenter(e, centre);
         if (!(std::abs(centre(2)) > farthest)) { continue; }
         farthest = std::abs(centre(2));
         z = centre(2);
         worst = e;
      }
      const Place at = place(mesh, worst);
      Place flat = at;
      flat.z = std::numeric_limits<double>::quiet_NaN();
      which << "; " << name(&flat.number) << " is at z = " << z
            << ": turn the mesh into the xy plane and write two coordinates";
   }
   require(false, "elastic body: the mesh is of dimension ", dimension,
           " in space of dimension ", space, ", both must be 2, or both 3", which.str());
}

/// The same numbers of three indices in another order: the second index takes the place of the
/// first, which runs along columns.
MatrixXd next_first(const MatrixXd &c)
{
   const MatrixXd turned = c.transpose();
   return Eigen::Map<const MatrixXd>(turned.data(), c.rows(), c.cols());
}

/// Bernstein coefficients (n × n²) of a polynomial of three variables, from its values. Their
/// first index runs fastest.
MatrixXd bernstein_of(const MatrixXd &of_values, const VectorXd &values)
{
   const Index n = of_values.rows();
   MatrixXd c = Eigen::Map<const MatrixXd>(values.data(), n, n * n);
   // Three turns lead back to the first index.
   for (int direction = 0; direction < 3; ++direction) { c = next_first(of_values * c); }
   return c;
}

/// True if the polynomial of these coefficients (n × n²) is above a level on the whole cube.
bool above_in_cube(const MatrixXd &c, double level, int depth = 6)
{
   if (c.minCoeff() > level) { return true; }
   const Index last = c.rows() - 1, n = c.rows();
   for (const Index row : {Index(0), last})
   {
      for (const Index column : {Index(0), last, n * last, n * n - 1})
      {
         if (c(row, column) <= level) { return false; }
      }
   }
   if (depth == 0) { return false; }
   for (const MatrixXd &half : halves(c))
   {
      for (const MatrixXd &quarter : halves(next_first(half)))
      {
         for (const MatrixXd &eighth : halves(next_first(quarter)))
         {
            if (!above_in_cube(next_first(eighth), level, depth - 1)) { return false; }
         }
      }
   }
   return true;
}

/// The points of a solid at which the determinant is sampled. They lie in a unit cube. For
/// tetrahedra and wedges, some sides of the cube collapse to edges or points.
class SolidShape
{
public:
   explicit SolidShape(const mfem::FiniteElement &map)
      : bernstein_(map.GetGeomType() == mfem::Geometry::TETRAHEDRON ? 3 * map.GetOrder() - 3
                                                                    : 3 * map.GetOrder() - 1)
   {
      const VectorXd &at = bernstein_.points;
      mfem::DenseMatrix gradient(map.GetDof(), 3);
      const bool tetrahedron = map.GetGeomType() == mfem::Geometry::TETRAHEDRON,
                 wedge = map.GetGeomType() == mfem::Geometry::PRISM;
      for (const double w : at)
      {
         for (const double v : at)
         {
            for (const double u : at)
            {
               mfem::IntegrationPoint point;
               point.Set3(u, tetrahedron || wedge ? v * (1 - u) : v,
                          tetrahedron ? w * (1 - u) * (1 - v) : w);
               map.CalcDShape(point, gradient);
               gradients_.emplace_back(
                  Eigen::Map<const MatrixXd>(gradient.Data(), map.GetDof(), 3));
            }
         }
      }
   }
   Fault fault(const mfem::DenseMatrix &nodes) const
   {
      const Eigen::Map<const MatrixXd> x(nodes.Data(), 3, nodes.Width());
      if (!x.allFinite()) { return Fault::none; } // reported for the node
      VectorXd determinant(static_cast<Index>(gradients_.size()));
      double edges = 0;
      for (Index k = 0; k < determinant.size(); ++k)
      {
         const Eigen::Matrix3d J = x * gradients_[k];
         determinant[k] = J.determinant();
         edges = std::max(edges, J.col(0).norm() * J.col(1).norm() * J.col(2).norm());
      }
      const double largest = determinant.cwiseAbs().maxCoeff();
      if (largest <= 1e-10 * edges) { return Fault::flat; }
      const MatrixXd c = bernstein_of(bernstein_.of_values, determinant);
      if (above_in_cube(c, tolerance * largest)) { return Fault::none; }
      return above_in_cube(-c, tolerance * largest) ? Fault::turned : Fault::folded;
   }

private:
   Bernstein bernstein_;
   std::vector<MatrixXd> gradients_; ///< nodes × 3, of each sample
};

/// check_elements() of a mesh in space.
void check_solids(mfem::Mesh &mesh)
{
   std::array<std::unique_ptr<SolidShape>, mfem::Geometry::NUM_GEOMETRIES> shapes;
   mfem::IsoparametricTransformation transformation;
   for (int e = 0; e < mesh.GetNE(); ++e)
   {
      mesh.GetElementTransformation(e, &transformation);
      const mfem::FiniteElement &map = *transformation.GetFE();
      const Place at = place(mesh, e);
      require(map.GetGeomType() != mfem::Geometry::PYRAMID, "elastic body: ", name(&at.number),
              " of the mesh is a pyramid, must be a hexahedron, a tetrahedron or a wedge");
      require(!mesh.NURBSext, "elastic body: the mesh is one of splines in space, must be one "
                              "of polynomials");
      auto &shape = shapes[map.GetGeomType()];
      if (!shape) { shape = std::make_unique<SolidShape>(map); }
      const Fault fault = shape->fault(transformation.GetPointMat());
      require(
         fault != Fault::flat, "elastic body: ", name(&at.number),
         " of the mesh has no volume: its corners coincide or lie in one plane; take it out "
         "or move its nodes apart");
      require(fault != Fault::turned, "elastic body: ", name(&at.number),
              " of the mesh is turned inside out (the determinant of its Jacobian is "
              "negative): number its nodes in the other sense");
      require(fault != Fault::folded, "elastic body: ", name(&at.number),
              " of the mesh is folded over (the determinant of its Jacobian changes sign or "
              "is zero within it): move its nodes so that it is convex");
   }
   for (int face = 0; face < mesh.GetNumFaces(); ++face)
   {
      int one = 0, other = 0, info_one = 0, info_other = 0;
      mesh.GetFaceElements(face, &one, &other);
      mesh.GetFaceInfos(face, &info_one, &info_other);
      // Seen from outside of each, faces turn counterclockwise: those of neighbours in opposite
      // senses, which MFEM numbers by odd orientations.
      if (other < 0 || info_other % 2 == 1) { continue; }
      const Place first = place(mesh, one), second = place(mesh, other);
      require(false, "elastic body: ", name(&first.number), " and ", name(&second.number),
              " of the mesh lie on the same side of the face that they share: the mesh is "
              "folded over there, move the nodes that were drawn across");
   }
}

} // namespace

std::vector<int> folded_elements(mfem::Mesh &mesh, const std::vector<int> &elements)
{
   Shapes shapes(mesh);
   std::vector<int> found;
   std::copy_if(elements.begin(), elements.end(), std::back_inserter(found),
                [&](int e) { return shapes.fault(e) != Fault::none; });
   return found;
}

void check_elements(mfem::Mesh &mesh)
{
   check_dimension(mesh);
   if (mesh.Dimension() == 3)
   {
      check_solids(mesh);
      return;
   }
   require(
      mesh.GetNE() == 0 || mesh.GetNEdges() > 0,
      "elastic body: the mesh has no edges, from which the boundary is found: finalize it with "
      "FinalizeMesh() or generate_edges = 1");
   const Ranks ranks(mesh);
   Shapes shapes(mesh);
   std::vector<double> faulty;
   for (int e = 0; e < mesh.GetNE() && faulty.empty(); ++e)
   {
      const Fault fault = shapes.fault(e);
      if (fault == Fault::none) { continue; }
      const Place at = place(mesh, e);
      faulty = {static_cast<double>(fault), at.number, at.attribute, at.x, at.y, at.z};
   }
   faulty = first_of_all(ranks, faulty, 6);
   if (!faulty.empty())
   {
      const auto fault = static_cast<Fault>(static_cast<int>(faulty[0]));
      require(false, "elastic body: ", name(&faulty[1]), " of the mesh ",
              fault == Fault::flat
                 ? "has no area: corners of it coincide or lie on one line; take it out or "
                   "move its nodes apart"
              : fault == Fault::turned
                 ? "is turned over (the determinant of its Jacobian is negative): number its "
                   "nodes counterclockwise"
                 : "is folded over (the determinant of its Jacobian changes sign or is zero "
                   "within it): move its nodes so that it is convex and its curved edges do "
                   "not cross");
   }
   std::vector<double> pair;
   for (int face = 0; face < mesh.GetNumFaces() && pair.empty(); ++face)
   {
      int one = 0, other = 0, info_one = 0, info_other = 0, hanging = 0;
      mesh.GetFaceElements(face, &one, &other);
      mesh.GetFaceInfos(face, &info_one, &info_other, &hanging);
      if (other < 0 || hanging >= 0) { continue; }
      const auto start = [&](int element, int info)
      {
         mfem::Array<int> vertices;
         mesh.GetElementVertices(element, vertices);
         return vertices[mesh.GetElement(element)->GetEdgeVertices(info / 64)[0]];
      };
      // Two counterclockwise elements go along their common edge in opposite directions.
      if (start(one, info_one) != start(other, info_other)) { continue; }
      const Place first = place(mesh, one), second = place(mesh, other);
      pair = {first.number,  first.attribute,  first.x,  first.y,  first.z,
              second.number, second.attribute, second.x, second.y, second.z};
   }
   pair = first_of_all(ranks, pair, 10);
   if (!pair.empty())
   {
      require(false, "elastic body: ", name(pair.data()), " and ", name(&pair[5]),
              " of the mesh lie on the same side of the edge that they share: the mesh is "
              "folded over there, move the nodes that were drawn across");
   }
}

} // namespace cattaneo

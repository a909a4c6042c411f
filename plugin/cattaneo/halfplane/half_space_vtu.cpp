#include <cattaneo/friction/settled_states.hpp>
#include <cattaneo/halfplane/half_space_vtu.hpp>
#include <cattaneo/halfplane/polygon_integrals.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;

namespace
{

/// An array of the file, one row per line.
void add_array(std::ostringstream &out, const char *name, const char *type,
               const Eigen::MatrixXd &values)
{
   out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
       << values.cols() << "\" format=\"ascii\">\n";
   for (Index i = 0; i < values.rows(); ++i)
   {
      for (Index k = 0; k < values.cols(); ++k)
      {
         out << (k ? " " : "") << exact_text(values(i, k));
      }
      out << '\n';
   }
   out << "</DataArray>\n";
}

/// Two components along the surface as vectors in space.
Eigen::MatrixX3d along_surface(const Eigen::VectorXd &components)
{
   const Index n = components.size() / 2;
   Eigen::MatrixX3d vectors = Eigen::MatrixX3d::Zero(n, 3);
   vectors.leftCols(2) = Eigen::Map<const Eigen::MatrixX2d>(components.data(), n, 2);
   return vectors;
}

} // namespace

void write_vtu(const std::string &file, const HalfSpace &contact, const ReducedProblem &problem,
               const ContactState &state)
{
   contact.validate();
   const Index n = contact.nodes();
   require(problem.position.rows() == n && problem.position.leftCols(2) == contact.middles() &&
              problem.components() == 2,
           "VTU file '", file, "': the reduced problem does not belong to these half-spaces");
   state.validate(problem);

   // Corners run round each cell. No two cells share corners.
   const std::vector<Polygon> cells = polygons_of(contact);
   const auto sides = static_cast<Index>(cells.front().size());
   Eigen::MatrixX3d corners = Eigen::MatrixX3d::Zero(sides * n, 3);
   Eigen::MatrixXd own(n, sides), ends(n, 1), kinds(n, 1), states(n, 1);
   const std::vector<NodeState> settled = settled_states(problem, state);
   for (Index i = 0; i < n; ++i)
   {
      const auto cell = static_cast<std::size_t>(i);
      for (Index k = 0; k < sides; ++k)
      {
         corners.row(sides * i + k).head(2) = cells[cell][static_cast<std::size_t>(k)];
         own(i, k) = static_cast<double>(sides * i + k);
      }
      ends(i, 0) = static_cast<double>(sides * (i + 1));
      kinds(i, 0) = sides == 3 ? 5 : 9; // VTK's triangle and quadrilateral
      states(i, 0) = static_cast<double>(settled[cell]);
   }
   const Eigen::VectorXd by_area = contact.areas().cwiseInverse();
   std::ostringstream out;
   out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
          "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\""
       << sides * n << "\" NumberOfCells=\"" << n << "\">\n<Points>\n";
   add_array(out, "Points", "Float64", corners);
   out << "</Points>\n<Cells>\n";
   add_array(out, "connectivity", "Int64", own);
   add_array(out, "offsets", "Int64", ends);
   add_array(out, "types", "UInt8", kinds);
   out << "</Cells>\n<CellData>\n";
   add_array(out, "pressure", "Float64", state.p.cwiseProduct(by_area));
   add_array(out, "shear", "Float64",
             along_surface(state.q.cwiseProduct(by_area.replicate(2, 1))));
   add_array(out, "slip", "Float64", along_surface(state.v));
   add_array(out, "opening", "Float64", state.w + problem.gap);
   add_array(out, "state", "Int8", states);
   out << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
   write_whole(file, out.str());
}

} // namespace cattaneo

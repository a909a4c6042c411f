#include <cattaneo/mesh/mesh_file.hpp>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cattaneo/exchange/off_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/deck_mesh.hpp>
#include <cattaneo/mesh/split_line.hpp>
#include <cattaneo/rounded.hpp>
#include <cattaneo/words.hpp>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

namespace cattaneo
{

namespace
{

/// The next word; those of comments (from # to the end of the line) are left out.
bool next_word(std::istream &in, std::string &word)
{
   while (in >> word)
   {
      if (word[0] != '#') { return true; }
      std::getline(in, word);
   }
   return false;
}

/// The next word as an integer; MFEM's are of 32 bits.
long integer(std::istream &in, const std::string &what)
{
   std::string word;
   require(next_word(in, word), "mesh file ends where ", what, " should be");
   char *end = nullptr;
   errno = 0;
   const long value = std::strtol(word.c_str(), &end, 10);
   constexpr long most = std::numeric_limits<int>::max();
   require(errno == 0 && *end == 0 && std::abs(value) <= most, "mesh file has '", word,
           "' for ", what, ", must be an integer of 32 bits");
   return value;
}

/// A count of items in the file. It cannot exceed the file's size.
long count(std::istream &in, const std::string &what, long most)
{
   const long value = integer(in, "the number of " + what);
   require(value >= 0 && value <= most, "mesh file has ", value, " for the number of ", what,
           ", must not be negative nor more than the file can hold");
   return value;
}

void check_attribute(long attribute, const std::string &what)
{
   require(attribute > 0 && attribute < 1000000000, "mesh file has the attribute ", attribute,
           " for ", what, ", must be positive");
}

std::string of_attribute(const std::string &what, long attribute)
{
   return what + " of attribute " + std::to_string(attribute);
}

void check_coordinate(const std::string &word, const std::string &what)
{
   char *end = nullptr;
   const double value = std::strtod(word.c_str(), &end);
   require(!word.empty() && *end == 0 && std::isfinite(value), "mesh file has the coordinate '",
           word, "' for ", what, ", must be a finite number");
}

/// Edges of the elements, by their ends, and boundary elements, which must be among them and be
/// there once. A load on an edge that is there twice would count twice.
class Edges
{
public:
   /// A segment is a boundary element. In other elements the first vertices are the corners.
   void add(const std::vector<long> &vertices, std::size_t corners, const std::string &what)
   {
      if (corners == 2)
      {
         const auto [first, is_new] = boundary_.emplace(ends(vertices[0], vertices[1]), what);
         require(is_new, "mesh file has one edge twice, as ", first->second, " and as ", what,
                 ": an edge must be in one part of the boundary only (in Gmsh, put each curve "
                 "into one physical group)");
      }
      for (std::size_t k = 0; k < corners && corners > 2; ++k)
      {
         const int elements = ++edges_[ends(vertices[k], vertices[(k + 1) % corners])];
         require(
            elements < 3, "mesh file has ", what,
            " on an edge that two earlier elements share, an edge must belong to at most two "
            "elements: is this one listed twice, or does it overlap others?");
      }
   }
   /// To be called at the end of a file.
   void check() const
   {
      require(!boundary_.empty(),
              "mesh file has no boundary elements, by which contact, supports "
              "and loads are named (in Gmsh, put the curves of the "
              "boundary into physical groups: Physical Curve(1) = {1, 2};)");
      for (const auto &[edge, what] : boundary_)
      {
         require(edges_.count(edge), "mesh file has the boundary ", what,
                 ", which is no edge of an element");
      }
   }

private:
   using Ends = std::pair<long, long>;
   static Ends ends(long a, long b) { return std::minmax(a, b); }
   std::map<Ends, int> edges_; ///< and the number of elements with these ends
   std::map<Ends, std::string> boundary_;
};

/// Faces of the solids, by their corners, and boundary elements, which must be among them and
/// be there once.
class Faces
{
public:
   void add_boundary(const std::vector<long> &corners, const std::string &what)
   {
      const auto [first, is_new] = boundary_.emplace(sorted(corners), what);
      require(is_new, "mesh file has one face twice, as ", first->second, " and as ", what,
              ": a face must be in one part of the boundary only (in Gmsh, put each surface "
              "into one physical group)");
   }
   /// @param corners first nodes of a tetrahedron (4), a wedge (6) or a hexahedron (8)
   void add_solid(const std::vector<long> &nodes, std::size_t corners, const std::string &what)
   {
      using Locals = std::vector<std::vector<int>>;
      static const std::map<std::size_t, Locals> all = {
         {4, {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}}},
         {6, {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
         {8,
          {{0, 1, 2, 3},
           {4, 5, 6, 7},
           {0, 1, 5, 4},
           {1, 2, 6, 5},
           {2, 3, 7, 6},
           {3, 0, 4, 7}}}};
      for (const std::vector<int> &face : all.at(corners))
      {
         std::vector<long> own;
         for (const int corner : face) { own.push_back(nodes[corner]); }
         require(++faces_[sorted(own)] < 3, "mesh file has ", what,
                 " on a face that two earlier elements share, a face must belong to at most "
                 "two elements: is this one listed twice, or does it overlap others?");
      }
   }
   /// At the end of a file.
   void check() const
   {
      require(!boundary_.empty(),
              "mesh file has no boundary elements, which contact, supports and loads are named "
              "by (in Gmsh, put the surfaces of the boundary into physical groups: Physical "
              "Surface(1) = {1, 2};)");
      for (const auto &[face, what] : boundary_)
      {
         require(faces_.count(face), "mesh file has the boundary ", what,
                 ", which is no face of an element");
      }
   }

private:
   static std::vector<long> sorted(std::vector<long> corners)
   {
      std::sort(corners.begin(), corners.end());
      return corners;
   }
   std::map<std::vector<long>, int> faces_; ///< and the number of elements with these corners
   std::map<std::vector<long>, std::string> boundary_;
};

/// MFEM mesh v1.x, up to the coordinates.
void check_mfem(std::istream &in, long size, int dimension_asked)
{
   const bool solid = dimension_asked == 3;
   Edges edges;
   Faces faces;
   // Vertices of MFEM's geometries: segment, triangle, quadrilateral, and in space tetrahedron,
   // cube and prism.
   const auto corners = [](long geometry)
   {
      static const std::array<long, 7> all = {0, 2, 3, 4, 4, 8, 6};
      return geometry < 1 || geometry > 6 ? 0 : all[geometry];
   };
   std::map<std::string, bool> found;
   long highest = -1, lowest = 0;
   std::string word;
   while (next_word(in, word))
   {
      found[word] = true;
      if (word == "dimension")
      {
         const long dimension = integer(in, "the dimension");
         require(dimension == dimension_asked, "mesh is of dimension ", dimension, ", must be ",
                 dimension_asked);
      }
      else if (word == "elements" || word == "boundary")
      {
         const bool boundary = word == "boundary";
         const std::string kind = boundary ? "boundary element " : "element ";
         const long elements = count(in, kind.substr(0, kind.size() - 1) + "s", size);
         for (long k = 0; k < elements; ++k)
         {
            const std::string what = kind + std::to_string(k);
            const long attribute = integer(in, "the attribute of " + what);
            check_attribute(attribute, what);
            const long geometry = integer(in, "the geometry of " + what);
            const bool flat = geometry == 2 || geometry == 3;
            require(solid ? (boundary ? flat : geometry >= 4 && geometry <= 6)
                          : (boundary ? geometry == 1 : flat),
                    "mesh file has the geometry ", geometry, " for ", what, ", must be ",
                    boundary && !solid   ? "1 (segment)"
                    : boundary || !solid ? "2 (triangle) or 3 (square)"
                                         : "4 (tetrahedron), 5 (cube) or 6 (prism)");
            std::vector<long> own;
            for (long v = 0; v < corners(geometry); ++v)
            {
               const long vertex = integer(in, "a vertex of " + what);
               require(std::find(own.begin(), own.end(), vertex) == own.end(),
                       "mesh file has vertex ", vertex, " twice in ", what);
               own.push_back(vertex);
               highest = std::max(highest, vertex);
               lowest = std::min(lowest, vertex);
            }
            if (!solid) { edges.add(own, own.size(), of_attribute(what, attribute)); }
            else if (boundary) { faces.add_boundary(own, of_attribute(what, attribute)); }
            else { faces.add_solid(own, own.size(), of_attribute(what, attribute)); }
         }
      }
      else if (word == "vertices")
      {
         const long vertices = count(in, "vertices", size);
         require(lowest >= 0 && highest < vertices, "mesh file has an element with vertex ",
                 lowest < 0 ? lowest : highest, ", must be 0 to ", vertices - 1);
         if (!next_word(in, word) || word == "nodes")
         {
            break;
         } // curved meshes: MFEM checks them
         require(word == std::to_string(dimension_asked), "mesh file has '", word,
                 "' for the number of coordinates, must be ", dimension_asked,
                 solid ? "" : ": the mesh must be in the xy plane");
         for (long k = 0; k < dimension_asked * vertices; ++k)
         {
            check_coordinate(next_word(in, word) ? word : "",
                             "vertex " + std::to_string(k / dimension_asked));
         }
         break;
      }
   }
   for (const char *section : {"dimension", "elements", "boundary", "vertices"})
   {
      require(found.count(section), "mesh file has no section '", section, "'");
   }
   if (solid) { faces.check(); }
   else { edges.check(); }
}

/// Reason why an element of Gmsh cannot belong to a plane body.
std::string why_not(long type)
{
   static const std::map<std::string, std::set<long>> solids = {
      {"tetrahedron", {4, 11, 29, 30, 31}},
      {"hexahedron", {5, 12, 17, 92, 93}},
      {"prism", {6, 13, 18, 90, 91}},
      {"pyramid", {7, 14, 19}}};
   for (const auto &[name, types] : solids)
   {
      if (types.count(type))
      {
         return "a " + name +
                ", but bodies must be plane: in Gmsh mesh their surface only (gmsh -2) "
                "and save no volume, or let the analysis be in space";
      }
   }
   return "one without inner nodes (type " + std::to_string(type) +
          "), must be a line, triangle or quadrilateral of order 1 to 5 with them: in Gmsh set "
          "Mesh.SecondOrderIncomplete = 0";
}

/// Reason why an element of Gmsh is no element of a body in space.
std::string why_not_in_space(long type)
{
   if (type == 17 || type == 18 || type == 16)
   {
      return "one without inner nodes (type " + std::to_string(type) +
             "): in Gmsh set Mesh.SecondOrderIncomplete = 0";
   }
   const GmshType &shape = gmsh_types().at(type);
   return shape.corners == 2
             ? "a line: in Gmsh save physical groups of surfaces and volumes only"
             : "of type " + std::to_string(type) +
                  ", must be a triangle, quadrilateral, tetrahedron, hexahedron "
                  "or prism of order 1 or 2";
}

/// The message that an element of Gmsh is in no physical group, and what to do. Its tags: the
/// physical group (0: none), then the curve or surface.
void check_group(const std::vector<long> &tags, std::size_t corners, const std::string &what)
{
   const std::string kind = corners == 2 ? "curve" : "surface",
                     place = tags.size() > 1 ? " " + std::to_string(tags[1]) : "";
   require(!tags.empty() && tags[0] != 0, "mesh file has ", what, ", of ", kind, place,
           ", in no physical group: in Gmsh put every curve of the boundary and every surface "
           "into one (Physical ",
           corners == 2 ? "Curve" : "Surface", "(1) = {", place.empty() ? "1" : place.substr(1),
           "};) and save nothing else (Mesh.SaveAll = 0)");
   check_attribute(tags[0], what);
}

void check_gmsh(const GmshMesh &mesh)
{
   require(!mesh.nodes.empty(), "mesh file has no nodes");
   Edges edges;
   int order = 0;
   bool has_areas = false;
   std::vector<Eigen::Vector3d> places; // of the elements' nodes
   std::vector<long> numbers;
   for (const GmshMesh::Element &element : mesh.elements)
   {
      // A mesh in space is not plane, whatever its groups are.
      require(gmsh_types().at(element.type).corners > 0, "mesh file has element ",
              element.number, ", ", why_not(element.type));
   }
   for (const GmshMesh::Element &element : mesh.elements)
   {
      const std::string what = "element " + std::to_string(element.number);
      const GmshType &shape = gmsh_types().at(element.type);
      if (order == 0) { order = shape.order; }
      require(shape.order == order, "mesh file has ", what, " of order ", shape.order,
              ", must be ", order, " as those before");
      check_group(element.tags, shape.corners, what);
      has_areas = has_areas || shape.corners > 2;
      std::set<long> own;
      for (long node : element.nodes)
      {
         require(own.insert(node).second, "mesh file has node ", node, " twice in ", what);
         const std::array<double, 3> &x = mesh.nodes.at(node);
         places.emplace_back(x[0], x[1], x[2]);
         numbers.push_back(node);
      }
      edges.add(element.nodes, shape.corners, of_attribute(what, element.tags[0]));
   }
   if (const std::optional<std::size_t> off = first_off_plane(places))
   {
      require(false, "mesh file has node ", numbers[*off], " at z = ", rounded(places[*off][2]),
              ", the first node at ", rounded(places[0][2]),
              ", must be equal: turn the mesh into the xy plane");
   }
   require(has_areas,
           "mesh file has no triangles or quadrilaterals: in Gmsh make a surface of the "
           "curves (Plane Surface), put it into a physical group (Physical "
           "Surface(1) = {1};) and mesh it (gmsh -2)");
   edges.check();
}

/// check_gmsh() of a mesh of solids.
void check_gmsh_solids(const GmshMesh &mesh)
{
   require(!mesh.nodes.empty(), "mesh file has no nodes");
   Faces faces;
   int order = 0;
   bool has_volumes = false;
   for (const GmshMesh::Element &element : mesh.elements)
   {
      const std::string what = "element " + std::to_string(element.number);
      const GmshType &shape = gmsh_types().at(element.type);
      const bool face = shape.corners > 2 && shape.order <= 2,
                 solid = shape.solid_corners > 0 && shape.order > 0;
      require(face || solid, "mesh file has ", what, ", ", why_not_in_space(element.type));
      if (order == 0) { order = shape.order; }
      require(shape.order == order, "mesh file has ", what, " of order ", shape.order,
              ", must be ", order, " as those before");
      require(!element.tags.empty() && element.tags[0] != 0, "mesh file has ", what, ", of a ",
              face ? "surface" : "volume",
              ", in no physical group: in Gmsh put every surface of the boundary and every "
              "volume into one (Physical ",
              face ? "Surface" : "Volume",
              "(1) = {1};) and save nothing else (Mesh.SaveAll = 0)");
      check_attribute(element.tags[0], what);
      std::set<long> own;
      for (long node : element.nodes)
      {
         require(own.insert(node).second, "mesh file has node ", node, " twice in ", what);
      }
      has_volumes = has_volumes || solid;
      const std::string called = of_attribute(what, element.tags[0]);
      if (solid) { faces.add_solid(element.nodes, shape.solid_corners, called); }
      else
      {
         faces.add_boundary({element.nodes.begin(), element.nodes.begin() + shape.corners},
                            called);
      }
   }
   require(has_volumes, "mesh file has no tetrahedra, hexahedra or prisms: in Gmsh make a "
                        "volume, put it into a physical group (Physical Volume(1) = {1};) and "
                        "mesh it (gmsh -3)");
   faces.check();
}

/// MFEM's message, without the places in its source.
std::string reason(std::string message)
{
   const std::size_t arrow = message.find("--> "), abort = message.find("abort: ");
   if (arrow != std::string::npos) { message.erase(0, arrow + 4); }
   else if (abort != std::string::npos) { message.erase(0, abort + 7); }
   message.erase(std::min(message.find("\n ... in function"), message.size()));
   return message;
}

/// Keeps MFEM from writing its errors to stderr, because it throws them as well, and from
/// writing to stdout that it reorients elements.
class Silence
{
public:
   Silence() : out_(mfem::out.IsEnabled())
   {
      mfem::err.Disable();
      mfem::out.Disable();
   }
   ~Silence()
   {
      mfem::err.Enable();
      if (out_) { mfem::out.Enable(); }
   }

private:
   bool out_;
};

/// Groups of Gmsh by their names; none for other files.
MeshNames gmsh_names(const std::string &file, int of_dimension)
{
   MeshNames names;
   std::ifstream in(file, std::ios::binary);
   std::string line;
   while (std::getline(in, line) && line.rfind("$PhysicalNames", 0) != 0)
   {
      if (line.rfind("$Nodes", 0) == 0) { return names; }
   }
   long expected = 0;
   in >> expected;
   for (long k = 0; k < expected; ++k)
   {
      int dimension = 0, number = 0;
      in >> dimension >> number;
      std::getline(in, line);
      const std::size_t from = line.find('"'), to = line.rfind('"');
      require(in.good() && from != std::string::npos && to > from, "mesh file: physical group ",
              k + 1, " of ", expected, " cannot be read, must be DIMENSION NUMBER \"NAME\"");
      std::string name = line.substr(from + 1, to - from - 1);
      std::replace(name.begin(), name.end(), ' ', '_');
      if (dimension == of_dimension - 1) { names.boundary[name] = {number}; }
      if (dimension == of_dimension) { names.elements[name] = number; }
   }
   return names;
}

/// The attributes of both lips of a line to split: that of the line, and the first that no line
/// has.
std::array<long, 2> lips(const GmshMesh &mesh, const MeshNames &names, const std::string &line)
{
   const auto found = names.boundary.find(line);
   std::vector<std::string> known;
   for (const auto &[name, attributes] : names.boundary) { known.push_back(name); }
   require(found != names.boundary.end(), "mesh file has no line '", line,
           "' to split, must be one of ", known.empty() ? "none" : listed(known));
   long highest = 0;
   for (const auto &[name, attributes] : names.boundary)
   {
      highest = std::max<long>(highest, attributes[0]);
   }
   for (const GmshMesh::Element &element : mesh.elements)
   {
      const bool is_line = gmsh_types().at(element.type).corners == 2;
      if (is_line && !element.tags.empty()) { highest = std::max(highest, element.tags[0]); }
   }
   return {found->second[0], highest + 1};
}

} // namespace

mfem::Mesh read_mesh(const std::string &file, std::vector<int> *curves, const MeshPart &part)
{
   require(part.name.empty() || is_deck(file), "mesh file has no part '", part.name,
           "': only decks (.inp) have parts");
   require(part.dimension == 2 || part.split.empty(), "mesh file has no line '", part.split,
           "' to split: only plane meshes have");
   require(part.split.empty() || !is_deck(file), "mesh file has no line '", part.split,
           "' to split: a deck has none, let two of its parts share the line");
   if (curves) { curves->clear(); }
   std::error_code why_not;
   const auto type = std::filesystem::status(file, why_not).type();
   require(type != std::filesystem::file_type::not_found,
           "mesh file cannot be read: there is no such file");
   std::ifstream in(file);
   require(in.good() && type == std::filesystem::file_type::regular, "mesh file cannot be read",
           type == std::filesystem::file_type::directory ? ": it is a folder" : "");
   const long size = static_cast<long>(std::filesystem::file_size(file));
   std::string line, converted;
   std::getline(in, line);
   if (is_deck(file) || line.rfind("$MeshFormat", 0) == 0)
   {
      GmshMesh mesh = is_deck(file) ? deck_mesh(file, part).mesh : read_gmsh(file, size);
      if (part.dimension == 3) { check_gmsh_solids(mesh); }
      else { check_gmsh(mesh); }
      if (!part.split.empty())
      {
         const std::array<long, 2> both = lips(mesh, gmsh_names(file, 2), part.split);
         split_line(mesh, both[0], both[1], part.split);
      }
      for (const GmshMesh::Element &element : mesh.elements)
      {
         // The messages about a deck are this program's own.
         if (!curves || part.dimension == 3 || is_deck(file) ||
             gmsh_types().at(element.type).corners != 2)
         {
            continue;
         }
         curves->push_back(element.tags.size() > 1 && element.tags[1] > 0
                              ? static_cast<int>(element.tags[1])
                              : -1);
      }
      converted = mesh.text();
   }
   else
   {
      require(size > 0, "mesh file is empty");
      require(line.rfind("$NOD", 0) != 0, "Gmsh file is of format 1, must be 4.1 or 2.2: save "
                                          "it anew (gmsh -2 NAME.geo, or File > Export as "
                                          "'Version 4 ASCII')");
      const std::string ending = std::filesystem::path(file).extension();
      static const std::set<std::string> others = {".odb", ".cae",  ".fil", ".frd",  ".sti",
                                                   ".mtx", ".step", ".stp", ".iges", ".stl",
                                                   ".vtk", ".vtu",  ".med", ".bdf",  ".nas"};
      std::string begins = line.substr(0, 20);
      for (char &c : begins) { c = c < ' ' || c > '~' ? '?' : c; } // of a binary file
      require(line.rfind("MFEM mesh v1.", 0) == 0,
              "mesh file must begin with 'MFEM mesh v1.' or '$MeshFormat' (Gmsh), or be a deck "
              "called .inp, not with '",
              begins, "'",
              ending == ".geo" ? ": this is a geometry, which gmsh -2 NAME.geo makes a mesh of"
              : ending == ".sti" || ending == ".mtx"
                 ? ": a stiffness is named by the key 'matrix' in place of 'mesh'"
              : others.count(ending) ? ": save the mesh in one of these formats"
                                     : "");
      require(part.split.empty(), "mesh file has no line '", part.split,
              "' to split: only Gmsh's files name lines");
      check_mfem(in, size, part.dimension);
   }
   in.close();
   const Silence silence;
   mfem::Mesh mesh;
   try
   {
      std::istringstream text(converted);
      mesh = converted.empty() ? mfem::Mesh(file.c_str(), 1, 1) : mfem::Mesh(text, 1, 1);
   }
   catch (const std::exception &error)
   {
      throw InputError("mesh file cannot be read: " + reason(error.what()));
   }
   return mesh;
}

MeshNames mesh_names(const std::string &file, const MeshPart &part)
{
   if (is_deck(file)) { return deck_mesh(file, part).names; }
   MeshNames names = gmsh_names(file, part.dimension);
   if (part.split.empty()) { return names; }
   const auto size = static_cast<long>(std::filesystem::file_size(file));
   const std::array<long, 2> both = lips(read_gmsh(file, size), names, part.split);
   names.boundary.erase(part.split);
   names.boundary[part.split + "+"] = {static_cast<int>(both[0])};
   names.boundary[part.split + "-"] = {static_cast<int>(both[1])};
   return names;
}

std::string unjoined_vertices(const mfem::Mesh &mesh, const std::string &name,
                              const std::vector<int> &meeting)
{
   struct Vertex
   {
      double along;
      Eigen::Vector3d at;
      double near;
      bool meets;
   };
   std::vector<Vertex> vertices;
   // The second coordinate of a mesh on a line was never read: check_elements() refuses it.
   if (mesh.SpaceDimension() < 2) { return ""; }
   const bool in_space = mesh.SpaceDimension() == 3;
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      const double *at = mesh.GetVertex(v);
      const Eigen::Vector3d place(at[0], at[1], in_space ? at[2] : 0);
      // Sorted along a direction that no mesh prefers, so that few nodes are near each other.
      const double along = place.dot(in_space ? Eigen::Vector3d(0.6691, 0.4686, 0.5769)
                                              : Eigen::Vector3d(0.8191, 0.5736, 0));
      vertices.push_back({along, place, 0, false});
   }
   double farthest = 0;
   for (int e = 0; e < mesh.GetNEdges(); ++e)
   {
      mfem::Array<int> ends;
      mesh.GetEdgeVertices(e, ends);
      Vertex &a = vertices[ends[0]], &b = vertices[ends[1]];
      const double near = 1e-3 * (a.at - b.at).norm();
      for (Vertex *end : {&a, &b})
      {
         end->near = end->near > 0 ? std::min(end->near, near) : near;
      }
      farthest = std::max(farthest, near);
   }
   for (int i = 0; i < mesh.GetNBE(); ++i)
   {
      if (!std::count(meeting.begin(), meeting.end(), mesh.GetBdrAttribute(i))) { continue; }
      mfem::Array<int> ends;
      mesh.GetBdrElementVertices(i, ends);
      for (int v : ends) { vertices[v].meets = true; }
   }
   std::sort(vertices.begin(), vertices.end(),
             [](const Vertex &a, const Vertex &b) { return a.along < b.along; });
   int pairs = 0;
   const Vertex *first = nullptr;
   for (std::size_t k = 0; k < vertices.size(); ++k)
   {
      const Vertex &a = vertices[k];
      for (std::size_t l = k + 1; l < vertices.size(); ++l)
      {
         const Vertex &b = vertices[l];
         if (b.along - a.along > farthest) { break; }
         if ((a.at - b.at).norm() > std::min(a.near, b.near)) { continue; }
         if (a.meets && b.meets) { continue; }
         ++pairs;
         if (!first) { first = &a; }
      }
   }
   if (pairs == 0) { return ""; }
   std::ostringstream text;
   text << "mesh '" << name << "': " << pairs
        << " pairs of nodes coincide (nearer than a thousandth of their edges), as at ("
        << first->at[0] << ", " << first->at[1];
   if (in_space) { text << ", " << first->at[2]; }
   text
      << "). The body is cut there, and its faces may pass through each other: name each face "
         "by itself and put an interface between them, or, if the body is one piece, merge "
         "the nodes (in Gmsh: Coherence Mesh)";
   return text.str();
}

std::string missed_curves(mfem::Mesh &mesh, int order, const std::string &name)
{
   const int bent = mesh.GetNodes() ? mesh.GetNodalFESpace()->GetMaxElementOrder() : 1;
   // check_elements() refuses a plane mesh out of the plane, so no warning is needed.
   const int dimension = mesh.Dimension();
   if (order >= bent || dimension < 2 || dimension != mesh.SpaceDimension()) { return ""; }
   // How far the mesh is from the curves through the nodes of its elements. Straight sides may
   // have many nodes.
   const mfem::H1_FECollection collection(order, dimension);
   double missed = 0;
   mfem::DenseMatrix at_nodes, exact;
   mfem::Vector low, high, x(dimension);
   for (int e = 0; e < mesh.GetNE(); ++e)
   {
      const mfem::FiniteElement &element =
         *collection.FiniteElementForGeometry(mesh.GetElementGeometry(e));
      const mfem::IntegrationRule &points =
         mfem::IntRules.Get(mesh.GetElementGeometry(e), 2 * bent);
      mfem::ElementTransformation &map = *mesh.GetElementTransformation(e);
      map.Transform(element.GetNodes(), at_nodes);
      map.Transform(points, exact);
      mfem::Vector shape(element.GetDof());
      for (int k = 0; k < points.GetNPoints(); ++k)
      {
         element.CalcShape(points.IntPoint(k), shape);
         at_nodes.Mult(shape, x);
         double off = 0;
         for (int c = 0; c < dimension; ++c) { off = std::hypot(off, x(c) - exact(c, k)); }
         missed = std::max(missed, off);
      }
   }
   mesh.GetBoundingBox(low, high);
   high -= low;
   if (missed <= 1e-10 * high.Max()) { return ""; }
   missed /= high.Max();
   std::ostringstream text;
   text
      << "the mesh of '" << name << "' is curved, but elements of order " << order
      << " follow it with an error of " << missed
      << " of its size, so that a rotation of the body causes false forces: use option -order "
      << bent;
   return text.str();
}

} // namespace cattaneo

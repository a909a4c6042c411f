#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/gmsh_file.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

namespace cattaneo
{

namespace
{

/// Number of nodes of a type of Gmsh's elements. InputError for an unknown type, because the
/// length of its entry in the file is not known.
int nodes_of(long type, const std::string &what)
{
   const auto found = gmsh_types().find(type);
   require(found != gmsh_types().end(), "mesh file has ", what, " of type ", type,
           ", must be a line, triangle or quadrilateral of order 1 to 5");
   return found->second.nodes;
}

/// The next entries of a file, in text or as Gmsh's binary numbers.
class Numbers
{
public:
   Numbers(const std::string &file, long size) : in_(file, std::ios::binary), size_(size) {}

   bool binary = false;

   std::istream &lines() { return in_; }
   void in_section(const std::string &name) { section_ = name; }
   /// An integer of 4 bytes.
   long integer() { return number<std::int32_t, long>(); }
   /// An integer of 8 bytes.
   long large() { return number<std::uint64_t, long>(); }
   double real() { return number<double, double>(); }
   /// A count of items. It is an error if the file is too short for that many.
   long count(long value)
   {
      require(value >= 0 && value <= size_, "mesh file has a count of ", value, " in ",
              section_, ", must not be negative nor more than the file can hold");
      return value;
   }
   /// A count that is text in any file.
   long written_count()
   {
      std::string line;
      std::getline(in_, line);
      std::istringstream words(line);
      long value = -1;
      require(bool(words >> value), "mesh file has '", line.substr(0, 40), "' in ", section_,
              ", must be a number");
      return count(value);
   }
   void skip_to(const std::string &end)
   {
      std::string line;
      while (std::getline(in_, line) && line.rfind(end, 0) != 0) {}
   }
   /// Requires that the section ends here.
   void require_end()
   {
      const std::string end = "$End" + section_.substr(1);
      std::string line;
      while (std::getline(in_, line) && line.find_first_not_of(" \t\r") == std::string::npos) {}
      require(line.rfind(end, 0) == 0, "mesh file has '", line.substr(0, 40), "' in ", section_,
              ", must be ", end);
   }

private:
   template <class Stored, class Value>
   Value number()
   {
      Value value{};
      if (binary)
      {
         Stored bytes{};
         in_.read(reinterpret_cast<char *>(&bytes), sizeof bytes);
         value = static_cast<Value>(bytes);
      }
      else { in_ >> value; }
      if constexpr (std::is_integral_v<Value>)
      {
         require(std::abs(value) <= std::numeric_limits<int>::max(), "mesh file has ", value,
                 " in ", section_, ", must be an integer of 32 bits");
      }
      if (in_.fail())
      {
         require(!in_.eof(), "mesh file ends within ", section_, ", must be whole");
         in_.clear();
         std::string word;
         in_ >> word;
         require(false, "mesh file has '", word.substr(0, 40), "' in ", section_,
                 ", must be a number");
      }
      return value;
   }

   std::ifstream in_;
   long size_;
   std::string section_;
};

/// Groups of curves and surfaces, by dimension and number.
using Groups = std::map<std::pair<long, long>, std::vector<long>>;

class GmshFile
{
public:
   GmshFile(const std::string &file, long size) : in_(file, size)
   {
      std::string line, version;
      std::getline(in_.lines(), line);
      std::getline(in_.lines(), line);
      std::istringstream words(line);
      int kind = 0, bytes = 0;
      words >> version >> kind >> bytes;
      require(version == "2.2" || version == "4.1", "Gmsh file is of format ", version,
              ", must be 4.1 or 2.2: save it anew (gmsh -2 NAME.geo, or File > Export as "
              "'Version 4 ASCII')");
      require(bytes == 8 && (kind == 0 || kind == 1), "Gmsh file is of type ", kind,
              " with numbers of ", bytes, " bytes, must be 0 (ASCII) or 1 (binary), with 8");
      newer_ = version == "4.1";
      in_.binary = kind == 1;
      if (in_.binary)
      {
         in_.in_section("$MeshFormat");
         require(in_.integer() == 1,
                 "Gmsh file was written on a machine with another order of bytes: "
                 "save it as ASCII");
      }
      while (std::getline(in_.lines(), line)) { section(line); }
   }
   GmshMesh mesh;

private:
   void section(const std::string &line)
   {
      const std::string name = line.substr(0, line.find_first_of(" \r\n"));
      in_.in_section(name);
      if (name == "$Entities") { read_entities(); }
      else if (name == "$Nodes") { newer_ ? read_nodes() : read_old_nodes(); }
      else if (name == "$Elements") { newer_ ? read_elements() : read_old_elements(); }
      else
      {
         require(name != "$PartitionedEntities", "Gmsh file is partitioned, must be one piece");
         if (name.size() > 1 && name[0] == '$' && name.rfind("$End", 0) != 0)
         {
            in_.skip_to("$End" + name.substr(1));
         }
         return;
      }
      in_.require_end();
   }
   void read_entities()
   {
      std::array<long, 4> counts{};
      for (long &count : counts) { count = in_.count(in_.large()); }
      for (long dimension = 0; dimension < 4; ++dimension)
      {
         for (long k = 0; k < counts[dimension]; ++k)
         {
            const long number = in_.integer();
            for (int c = 0; c < (dimension == 0 ? 3 : 6); ++c) { in_.real(); }
            std::vector<long> &groups = groups_[{dimension, number}];
            for (long left = in_.count(in_.large()); left > 0; --left)
            {
               groups.push_back(std::abs(in_.integer()));
            }
            if (dimension == 0) { continue; }
            for (long left = in_.count(in_.large()); left > 0; --left) { in_.integer(); }
         }
      }
   }
   void read_nodes()
   {
      const long blocks = in_.count(in_.large());
      for (int k = 0; k < 3; ++k) { in_.large(); }
      for (long block = 0; block < blocks; ++block)
      {
         const long dimension = in_.integer();
         in_.integer();
         const bool parametric = in_.integer() != 0;
         std::vector<long> numbers(in_.count(in_.large()));
         for (long &number : numbers) { number = in_.large(); }
         for (long number : numbers)
         {
            const double x = in_.real(), y = in_.real(), z = in_.real();
            for (long c = 0; parametric && c < dimension; ++c) { in_.real(); }
            mesh.add_node(number, {x, y, z});
         }
      }
   }
   void read_old_nodes()
   {
      const long count = in_.written_count();
      for (long k = 0; k < count; ++k)
      {
         const long number = in_.integer();
         const double x = in_.real(), y = in_.real(), z = in_.real();
         mesh.add_node(number, {x, y, z});
      }
   }
   void read_elements()
   {
      const long blocks = in_.count(in_.large());
      for (int k = 0; k < 3; ++k) { in_.large(); }
      for (long block = 0; block < blocks; ++block)
      {
         const long dimension = in_.integer(), entity = in_.integer(), type = in_.integer();
         const std::vector<long> &groups = groups_[{dimension, entity}];
         const long count = in_.count(in_.large());
         require(groups.size() < 2 || dimension == 0, "mesh file has a ",
                 dimension == 1   ? "curve, "
                 : dimension == 2 ? "surface, "
                                  : "volume, ",
                 entity, ", in two physical groups, must be in one only");
         for (long k = 0; k < count; ++k)
         {
            const long number = in_.large();
            std::vector<long> own(nodes_of(type, "element " + std::to_string(number)));
            for (long &node : own) { node = in_.large(); }
            mesh.add_element(number, type, {groups.empty() ? 0 : groups[0], entity},
                             std::move(own));
         }
      }
   }
   void read_old_elements()
   {
      const long count = in_.written_count();
      for (long k = 0; k < count;)
      {
         // In text each element has its type and tags, in binary files blocks of them have.
         long number = in_.binary ? 0 : in_.integer();
         const long type = in_.integer(), block = in_.binary ? in_.count(in_.integer()) : 1;
         const long tags = in_.count(in_.integer());
         require(block > 0, "mesh file has a block of ", block,
                 " elements, must be at least 1");
         for (long e = 0; e < block; ++e, ++k)
         {
            if (in_.binary) { number = in_.integer(); }
            std::vector<long> own_tags(tags),
               own(nodes_of(type, "element " + std::to_string(number)));
            for (long &tag : own_tags) { tag = in_.integer(); }
            for (long &node : own) { node = in_.integer(); }
            mesh.add_element(number, type, own_tags, std::move(own));
         }
      }
   }

   Numbers in_;
   bool newer_ = false;
   Groups groups_;
};

} // namespace

const std::map<long, GmshType> &gmsh_types()
{
   static const std::map<long, GmshType> types = {
      {15, {1, 1, 0}},   {1, {2, 2, 1}},      {8, {3, 2, 2}},      {26, {4, 2, 3}},
      {27, {5, 2, 4}},   {28, {6, 2, 5}},     {2, {3, 3, 1}},      {9, {6, 3, 2}},
      {21, {10, 3, 3}},  {23, {15, 3, 4}},    {25, {21, 3, 5}},    {3, {4, 4, 1}},
      {10, {9, 4, 2}},   {36, {16, 4, 3}},    {37, {25, 4, 4}},    {38, {36, 4, 5}},
      {16, {8, 0, 0}},   {20, {9, 0, 0}},     {22, {12, 0, 0}},    {24, {15, 0, 0}},
      {4, {4, 0, 1, 4}}, {11, {10, 0, 2, 4}}, {29, {20, 0, 0}},    {30, {35, 0, 0}},
      {31, {56, 0, 0}},  {5, {8, 0, 1, 8}},   {12, {27, 0, 2, 8}}, {17, {20, 0, 0}},
      {92, {64, 0, 0}},  {93, {125, 0, 0}},   {6, {6, 0, 1, 6}},   {13, {18, 0, 2, 6}},
      {18, {15, 0, 0}},  {90, {40, 0, 0}},    {91, {75, 0, 0}},    {7, {5, 0, 0}},
      {14, {14, 0, 0}},  {19, {13, 0, 0}}};
   return types;
}

void GmshMesh::add_node(long number, const std::array<double, 3> &x)
{
   for (double coordinate : x)
   {
      require(std::isfinite(coordinate), "mesh file has the coordinate ", coordinate,
              " for node ", number, ", must be a finite number");
   }
   require(nodes.emplace(number, x).second, "mesh file has node ", number, " twice");
}

void GmshMesh::add_element(long number, long type, std::vector<long> tags,
                           std::vector<long> own)
{
   if (type == 15) { return; }
   for (long node : own)
   {
      require(nodes.count(node), "mesh file has node ", node, " in element ", number,
              ", which is not among its nodes");
   }
   if (type == 16)
   {
      std::array<double, 3> middle{0, 0, 0};
      for (std::size_t k = 0; k < own.size(); ++k)
      {
         for (int c = 0; c < 3; ++c) { middle[c] += (k < 4 ? -0.25 : 0.5) * nodes[own[k]][c]; }
      }
      type = 10;
      own.push_back(nodes.rbegin()->first + 1);
      add_node(own.back(), middle);
   }
   elements.push_back({number, type, std::move(tags), std::move(own)});
}

std::string GmshMesh::text() const
{
   std::ostringstream out;
   out.precision(17);
   out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << nodes.size() << '\n';
   for (const auto &[number, x] : nodes)
   {
      out << number << ' ' << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
   }
   out << "$EndNodes\n$Elements\n" << elements.size() << '\n';
   for (const Element &element : elements)
   {
      out << element.number << ' ' << element.type << ' ' << element.tags.size();
      for (long tag : element.tags) { out << ' ' << tag; }
      for (long node : element.nodes) { out << ' ' << node; }
      out << '\n';
   }
   out << "$EndElements\n";
   return out.str();
}

GmshMesh read_gmsh(const std::string &file, long size)
{
   return GmshFile(file, size).mesh;
}

} // namespace cattaneo

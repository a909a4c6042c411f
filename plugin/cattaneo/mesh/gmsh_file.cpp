#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/gmsh_file.hpp>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace cattaneo
{

namespace
{

/// Nodes of an element of Gmsh by its type; of others no file of a plane body can be read.
int nodes_of(long type, const std::string &what)
{
   static const std::map<long, int> known = {
      {15, 1},  {1, 2},   {8, 3},   {26, 4},  {27, 5},  {28, 6},  {2, 3},   {9, 6},   {21, 10},
      {23, 15}, {25, 21}, {3, 4},   {16, 8},  {10, 9},  {36, 16}, {37, 25}, {38, 36}, {4, 4},
      {5, 8},   {6, 6},   {7, 5},   {11, 10}, {12, 27}, {13, 18}, {14, 14}, {17, 20}, {18, 15},
      {19, 13}, {20, 9},  {22, 12}, {24, 15}, {29, 20}, {30, 35}, {31, 56}};
   const auto found = known.find(type);
   require(found != known.end(), "mesh file has ", what, " of type ", type,
           ", must be a line, triangle or quadrilateral of order 1 to 5");
   return found->second;
}

/// What follows in a file, in text or as Gmsh's binary numbers.
class Numbers
{
public:
   Numbers(const std::string &file, long size) : in_(file, std::ios::binary), size_(size) {}

   bool binary = false;

   std::istream &lines() { return in_; }
   void in_section(const std::string &name) { section_ = name; }
   /// Of 4 bytes.
   long integer() { return number<std::int32_t, long>(); }
   /// Of 8 bytes.
   long large() { return number<std::uint64_t, long>(); }
   double real() { return number<double, double>(); }
   /// How many of something there are, no more than the file can hold.
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
      while (std::getline(in_, line))
      {
         if (line.rfind(end, 0) == 0) { return; }
      }
      require(false, "mesh file has no ", end);
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
      require(in_.good() || (in_.eof() && !in_.fail()), "mesh file ends within ", section_,
              ", or has there what is no number");
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
              ", must be 4.1 or 2.2: save it anew (gmsh -2 NAME.geo)");
      require(bytes == 8, "Gmsh file has numbers of ", bytes, " bytes, must be of 8");
      newer_ = version == "4.1";
      in_.binary = kind == 1;
      if (in_.binary)
      {
         in_.in_section("$MeshFormat");
         require(in_.integer() == 1, "Gmsh file is of a machine with another order of bytes: "
                                     "save it as ASCII");
      }
      while (std::getline(in_.lines(), line)) { section(line); }
   }
   std::string text() const { return text_.text(); }

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
      in_.skip_to("$End" + name.substr(1));
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
            text_.add_node(number, {x, y, z});
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
         text_.add_node(number, {x, y, z});
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
                 dimension == 1 ? "curve, " : "surface, ", entity,
                 ", in two physical groups, must be in one");
         for (long k = 0; k < count; ++k)
         {
            const long number = in_.large();
            std::vector<long> own(nodes_of(type, "element " + std::to_string(number)));
            for (long &node : own) { node = in_.large(); }
            text_.add_element(number, type, {groups.empty() ? 0 : groups[0], entity},
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
            text_.add_element(number, type, own_tags, std::move(own));
         }
      }
   }

   Numbers in_;
   bool newer_ = false;
   Groups groups_;
   GmshText text_;
};

} // namespace

void GmshText::add_node(long number, const std::array<double, 3> &x)
{
   require(nodes_.emplace(number, x).second, "mesh file has node ", number, " twice");
}

void GmshText::add_element(long number, long type, const std::vector<long> &tags,
                           std::vector<long> nodes)
{
   if (type == 15) { return; }
   if (type == 16)
   {
      std::array<double, 3> middle{0, 0, 0};
      for (std::size_t k = 0; k < nodes.size(); ++k)
      {
         const auto at = nodes_.find(nodes[k]);
         require(at != nodes_.end(), "mesh file has node ", nodes[k], " in element ", number,
                 ", which is not among its nodes");
         for (int c = 0; c < 3; ++c) { middle[c] += (k < 4 ? -0.25 : 0.5) * at->second[c]; }
      }
      type = 10;
      nodes.push_back(nodes_.rbegin()->first + 1);
      add_node(nodes.back(), middle);
   }
   std::ostringstream line;
   line << number << ' ' << type << ' ' << tags.size();
   for (long tag : tags) { line << ' ' << tag; }
   for (long node : nodes) { line << ' ' << node; }
   elements_ += line.str() + '\n';
   ++count_;
}

std::string GmshText::text() const
{
   std::ostringstream out;
   out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << nodes_.size() << '\n';
   for (const auto &[number, x] : nodes_)
   {
      char line[120];
      std::snprintf(line, sizeof line, "%ld %.17g %.17g %.17g\n", number, x[0], x[1], x[2]);
      out << line;
   }
   out << "$EndNodes\n$Elements\n" << count_ << '\n' << elements_ << "$EndElements\n";
   return out.str();
}

std::string as_gmsh_22(const std::string &file, long size)
{
   return GmshFile(file, size).text();
}

bool needs_gmsh_22(const std::string &file)
{
   std::ifstream in(file, std::ios::binary);
   std::string line, version;
   std::getline(in, line);
   std::getline(in, line);
   std::istringstream words(line);
   int kind = 0;
   words >> version >> kind;
   if (version == "4.1" || kind == 1) { return version == "4.1" || version == "2.2"; }
   while (std::getline(in, line) && line.rfind("$Elements", 0) != 0) {}
   while (std::getline(in, line))
   {
      long number = 0, type = 0;
      if (std::istringstream(line) >> number >> type && type == 16) { return true; }
   }
   return false;
}

} // namespace cattaneo

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cattaneo/exchange/input_deck.hpp>
#include <cattaneo/exchange/line_reader.hpp>
#include <cattaneo/exchange/off_plane.hpp>
#include <cattaneo/exchange/outer_edges.hpp>
#include <cattaneo/rounded.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

namespace cattaneo
{

namespace
{

/// "*NODE, NSET=ALL": its name and parameters, in capitals.
struct Keyword
{
   std::string name;
   std::map<std::string, std::string> parameters;

   std::string parameter(const std::string &key) const
   {
      const auto found = parameters.find(key);
      return found == parameters.end() ? "" : found->second;
   }
};

/// Number of corners of an element by its type in capitals: CPE4, CAX8R, CPS3, …, M3D9 (Gmsh's
/// name for quadrilaterals of 9 nodes), or T3D2, a truss, by which some programs name lines. 0
/// for other types.
std::size_t corners_of(const std::string &type)
{
   const std::string family = type.substr(0, 3);
   const std::size_t nodes = type.size() > 3 ? static_cast<std::size_t>(type[3] - '0') : 0;
   if (family == "T2D" || family == "T3D") { return 2; }
   if (type == "M3D9") { return 4; }
   if (family != "CPE" && family != "CPS" && family != "CAX") { return 0; }
   return nodes == 3 || nodes == 6 ? 3 : nodes == 4 || nodes == 8 ? 4 : 0;
}

/// Nodes of a solid by its type in capitals, C3D8 or C3D20R; 0 of another.
std::size_t nodes_of_solid(const std::string &type)
{
   if (type.substr(0, 3) != "C3D") { return 0; }
   std::size_t nodes = 0, k = 3;
   for (; k < type.size() && std::isdigit(static_cast<unsigned char>(type[k])); ++k)
   {
      nodes = 10 * nodes + static_cast<std::size_t>(type[k] - '0');
   }
   static const std::set<std::size_t> known = {4, 6, 8, 10, 15, 20};
   return known.count(nodes) ? nodes : 0;
}

/// A side of an element that a surface names; -1: all outer sides of the element.
struct Face
{
   std::string surface, place;
   std::size_t element = 0;
   int side = -1;
};

/// A part, an instance, or the contents of a deck without parts.
struct Block
{
   std::string name; ///< of an instance or a part, else empty
   InputDeck deck;
   std::map<int, std::size_t> index; ///< of elements by their numbers
   std::map<int, double> z;          ///< of nodes, where it is not 0
   std::vector<Face> faces;
   std::optional<Formulation> formulation; ///< of its elements

   bool has_nodes() const { return !deck.places.empty(); }
   /// Finds a set by its name in capitals, with or without the name of the instance.
   template <class Sets>
   auto find(Sets &sets, const std::string &set) const
   {
      for (const std::string &spelled : {set, name + "." + set, without_instance(set)})
      {
         const auto found = sets.find(spelled);
         if (found != sets.end()) { return found; }
      }
      return sets.end();
   }
   static std::string without_instance(const std::string &set)
   {
      return set.substr(std::min(set.rfind('.') + 1, set.size()));
   }
};

/// Turns and moves a block.
struct Placement
{
   Eigen::Vector2d shift{0, 0}, centre{0, 0};
   double lift = 0, angle = 0; ///< along z, about it
};

class DeckReader
{
public:
   explicit DeckReader(DeckUse use) : use_(use) {}
   void read(const std::string &file, int depth);
   /// Statements for the whole deck.
   InputDeck finish(const std::string &file, const DeckPart &part);

private:
   void begin(LineReader &in, int depth);
   void begin_card(const LineReader &in);
   void require_known(const LineReader &in) const;
   void begin_block(const LineReader &in);
   void data(LineReader &in);
   void place_instance(const LineReader &in, const std::vector<std::string_view> &fields);
   void node(const LineReader &in, const std::vector<std::string_view> &fields);
   void element(LineReader &in);
   void elastic(const LineReader &in, const std::vector<std::string_view> &fields);
   void members(const LineReader &in, const std::vector<std::string_view> &fields);
   void surface(const LineReader &in, const std::vector<std::string_view> &fields);
   void load(const LineReader &in, const std::vector<std::string_view> &fields);
   void support(const LineReader &in, const std::vector<std::string_view> &fields);
   /// The place for nodes and elements that a card gives by numbers alone.
   Block &home();
   /// The places in which a name in a card is searched.
   std::vector<Block *> blocks_of(const LineReader &in, std::string_view name);
   template <class Found>
   struct In
   {
      Block *block;
      std::vector<Found> members;
   };
   std::vector<In<int>> nodes_of(const LineReader &in, std::string_view name);
   std::vector<int> nodes_of_one(const LineReader &in, std::string_view name);
   /// Indices of an element, or of a set of them.
   std::vector<In<std::size_t>> elements_of(const LineReader &in, std::string_view name);
   /// The numbers of GENERATE's first, last and step that exist (`has`).
   template <class Has>
   std::vector<int> generated(const LineReader &in, const std::vector<std::string_view> &fields,
                              Has has) const;
   Block &chosen(const std::string &file, const DeckPart &part);

   DeckUse use_;
   Keyword keyword_;
   int loads_ = 0, displacements_ = 0, instance_lines_ = 0;
   std::string material_;
   std::set<std::string> unknown_materials_; ///< that are not isotropic, or change
   Block whole_;
   std::map<std::string, Block> parts_;
   std::vector<std::unique_ptr<Block>> instances_;
   Block *part_ = nullptr; ///< that is being read
   std::set<std::string> keywords_;
   std::vector<Card> cards_;
   std::map<std::string, DeckMaterial> materials_;
   bool is_axisymmetric_ = false;
};

/// A set that is named or listed several times has each member once, in the order of the file.
template <class Member>
void drop_repeated(std::vector<Member> &members)
{
   std::set<Member> seen;
   const auto again = [&](Member member) { return !seen.insert(member).second; };
   members.erase(std::remove_if(members.begin(), members.end(), again), members.end());
}

std::string place(const LineReader &in)
{
   return "file '" + in.file() + "', line " + std::to_string(in.line_number());
}

bool is_number(std::string_view field)
{
   return !field.empty() && std::isdigit(static_cast<unsigned char>(field[0]));
}

void DeckReader::read(const std::string &file, int depth)
{
   LineReader in(file);
   keyword_ = {};
   while (in.next())
   {
      const std::string_view line = trimmed(in.line());
      if (upper_case(line) == "** AXISYMMETRIC") { is_axisymmetric_ = true; }
      if (line.substr(0, 2) == "**") { continue; }
      if (line[0] == '*') { begin(in, depth); }
      else { data(in); }
   }
}

void DeckReader::begin(LineReader &in, int depth)
{
   keyword_ = {};
   std::string file;
   for (;;)
   {
      for (const std::string_view field : in.fields())
      {
         if (field.substr(0, 1) == "*")
         {
            keyword_.name = upper_case(field.substr(1));
            continue;
         }
         const std::size_t equals = std::min(field.find('='), field.size());
         std::string_view value = trimmed(field.substr(std::min(equals + 1, field.size())));
         if (value.size() > 1 && value.front() == '"')
         {
            value = value.substr(1, value.size() - 2);
         }
         const std::string key = upper_case(trimmed(field.substr(0, equals)));
         keyword_.parameters[key] = upper_case(value);
         if (key == "INPUT") { file = value; }
      }
      if (trimmed(in.line()).back() != ',' || !in.next()) { break; } // goes on in the next line
   }
   const std::string &name = keyword_.name;
   if (name == "INCLUDE")
   {
      in.require(!file.empty(), "*INCLUDE has no INPUT, must name a file");
      in.require(depth < 10, "files include each other more than 10 deep, must not");
      const std::filesystem::path beside =
         std::filesystem::path(in.file()).parent_path() / file;
      std::error_code unknown;
      in.require(!std::filesystem::equivalent(beside, in.file(), unknown), "*INCLUDE of '",
                 file, "' is within that file itself, must name another");
      read(beside.string(), depth + 1);
      keyword_ = {};
   }
   begin_card(in);
}

/// InputError for cards that would change the body from the one that is read.
void DeckReader::require_known(const LineReader &in) const
{
   const std::string &name = keyword_.name;
   static const std::set<std::string> makers = {"NGEN",  "NFILL",  "NCOPY",  "NMAP",
                                                "ELGEN", "ELCOPY", "SYSTEM", "IMPORT"};
   in.require(makers.count(name) == 0, "*", name,
              " generates or moves nodes or elements, which is not supported: "
              "write out all nodes and elements with the program that made the deck");
   const bool has_mesh = name == "NODE" || name == "ELEMENT" || name == "NSET" ||
                         name == "ELSET" || name == "SURFACE";
   in.require(!has_mesh || keyword_.parameter("INPUT").empty(), "*", name,
              " has its lines in a file of its own (INPUT=), must have them here, or in an "
              "*INCLUDE");
   in.require(name != "NODE" || keyword_.parameter("SYSTEM").substr(0, 1) != "C",
              "*NODE has cylindrical coordinates (SYSTEM=C), must have x and y");
   static const std::set<std::string> couplings = {"EQUATION",
                                                   "MPC",
                                                   "RIGID BODY",
                                                   "COUPLING",
                                                   "KINEMATIC",
                                                   "DISTRIBUTING",
                                                   "DISTRIBUTING COUPLING",
                                                   "KINEMATIC COUPLING",
                                                   "EMBEDDED ELEMENT",
                                                   "TIE",
                                                   "CYCLIC SYMMETRY MODEL"};
   // A mesh is geometry only. The message names what in the case has the effect of the card.
   in.require(
      use_ == DeckUse::stiffness || couplings.count(name) == 0, "*", name,
      name == "TIE"
         ? " joins sides of bodies, must be left out: an interface between these sides "
           "in the case joins them, with the key 'tied'"
      : name == "RIGID BODY" || name.find("COUPLING") != std::string::npos ||
            name == "KINEMATIC" || name == "DISTRIBUTING"
         ? " moves nodes as one block, must be left out: a guide in the case does (key "
           "'guides')"
      : name == "EQUATION" || name == "MPC"
         ? " lets nodes move with others, must be left out: say in the case what it "
           "stands for, a support, a guide, or an interface that is tied"
         : " lets nodes move with others, must be left out: the case has no such thing");
   if (use_ != DeckUse::stiffness) { return; }
   in.require(
      couplings.count(name) == 0, "*", name,
      " makes nodes depend on others, so that rows of the matrix belong to several nodes: it "
      "must be left out when the matrix is written");
   in.require(name != "TRANSFORM", "*TRANSFORM turns directions of nodes, must be left out: "
                                   "everything is read in x and y");
   in.require(
      name != "CONTACT PAIR" && name != "PRE-TENSION SECTION", "*", name,
      " makes nodes depend on others, so that rows of the matrix belong to several nodes: it "
      "must be left out when the matrix is written");
}

/// *PART, *INSTANCE and their ends.
void DeckReader::begin_block(const LineReader &in)
{
   const std::string &name = keyword_.name, called = keyword_.parameter("NAME");
   if (name == "END PART" || name == "ASSEMBLY") { part_ = nullptr; }
   if (name == "PART")
   {
      in.require(parts_.count(called) == 0, "the *PART '", called,
                 "' is there a second time, must be there once");
      part_ = &parts_[called];
      part_->name = called;
   }
   if (name != "INSTANCE") { return; }
   part_ = nullptr;
   instance_lines_ = 0;
   const std::string of = keyword_.parameter("PART");
   const auto part = parts_.find(of);
   in.require(part != parts_.end(), "the *INSTANCE '", called, "' is of the part '", of,
              "', which must be there before it");
   in.require(use_ != DeckUse::stiffness || instances_.empty(),
              "a second *INSTANCE begins. Beside a "
              "matrix there must be one, because "
              "node numbers of several "
              "instances coincide");
   for (const auto &other : instances_)
   {
      in.require(other->name != called, "the *INSTANCE '", called,
                 "' is there a second time, must be there once");
   }
   auto made = std::make_unique<Block>(part->second);
   made->name = called;
   // A set S of the part becomes INSTANCE.S, so that a set of the assembly may be called S too.
   const auto rename = [&](auto &sets)
   {
      auto renamed = std::move(sets);
      sets.clear();
      for (auto &[set, members] : renamed) { sets[called + "." + set] = std::move(members); }
   };
   rename(made->deck.node_sets);
   rename(made->deck.element_sets);
   for (Face &face : made->faces) { face.surface = called + "." + face.surface; }
   instances_.push_back(std::move(made));
}

void DeckReader::begin_card(const LineReader &in)
{
   const std::string &name = keyword_.name;
   keywords_.insert(name);
   if (name == "INITIAL CONDITIONS")
   {
      keywords_.insert(name + ", TYPE=" + keyword_.parameters["TYPE"]);
   }
   require_known(in);
   begin_block(in);
   if (name == "MATERIAL") { material_ = keyword_.parameter("NAME"); }
   if (name == "ELASTIC")
   {
      const std::string type = keyword_.parameter("TYPE");
      if (!type.empty() && type.substr(0, 3) != "ISO") { unknown_materials_.insert(material_); }
   }
   if (name == "SOLID SECTION")
   {
      const std::string set = upper_case(keyword_.parameter("ELSET"));
      bool found = false;
      for (Block *block : blocks_of(in, set))
      {
         const auto its = block->find(block->deck.element_sets, set);
         if (its == block->deck.element_sets.end()) { continue; }
         found = true;
         block->deck.sections.push_back(keyword_.parameter("MATERIAL"));
         for (std::size_t e : its->second)
         {
            block->deck.elements[e].section = static_cast<int>(block->deck.sections.size());
         }
      }
      if (!found) { home().deck.sections.push_back(keyword_.parameter("MATERIAL")); }
   }
   const std::string elements = keyword_.parameter("ELSET");
   if (name == "NSET" && !elements.empty())
   {
      for (const auto &[block, some] : elements_of(in, elements))
      {
         InputDeck::Nodes &set = block->deck.node_sets[keyword_.parameter("NSET")];
         for (std::size_t e : some)
         {
            const InputDeck::Nodes &nodes = block->deck.elements[e].nodes;
            set.insert(set.end(), nodes.begin(), nodes.end());
         }
      }
   }
   if (name == "CLOAD")
   {
      cards_.push_back({"CLOAD" + std::to_string(++loads_), Control::force, {}});
   }
   if (name == "BOUNDARY")
   {
      cards_.push_back(
         {"BOUNDARY" + std::to_string(++displacements_), Control::displacement, {}});
   }
}

void DeckReader::data(LineReader &in)
{
   const std::string &name = keyword_.name;
   const std::vector<std::string_view> fields = in.fields();
   if (fields.empty()) { return; } // a comma alone
   if (name == "NODE") { node(in, fields); }
   else if (name == "ELEMENT") { element(in); }
   else if (name == "NSET" || name == "ELSET") { members(in, fields); }
   else if (name == "SURFACE") { surface(in, fields); }
   else if (name == "INSTANCE") { place_instance(in, fields); }
   else if (name == "ELASTIC") { elastic(in, fields); }
   else if (name == "SOLID SECTION" && !fields[0].empty())
   {
      const double thickness = in.number(fields[0], "the thickness of *SOLID SECTION");
      in.require(thickness == 1, "the thickness of *SOLID SECTION is ", thickness,
                 ", must be 1, as stiffness and forces are per thickness",
                 use_ != DeckUse::stiffness ? ": key 'thickness' of the case says it" : "");
   }
   // Supports and loads of a mesh are in the case.
   else if (name == "CLOAD" && use_ == DeckUse::stiffness) { load(in, fields); }
   else if (name == "BOUNDARY" && use_ == DeckUse::stiffness) { support(in, fields); }
}

/// First line: the translation. Second line: an axis by two points, and the angle in degrees of
/// a rotation that follows.
void DeckReader::place_instance(const LineReader &in,
                                const std::vector<std::string_view> &fields)
{
   ++instance_lines_;
   const std::size_t count = instance_lines_ == 1 ? 3 : 7;
   in.require(instance_lines_ < 3 && (fields.size() == count || instance_lines_ == 1), "line ",
              instance_lines_, " of *INSTANCE has ", fields.size(),
              " numbers, must be one of 3 (how far it is moved) and one of 7 (two points of an "
              "axis, an angle)");
   std::array<double, 7> x{};
   for (std::size_t k = 0; k < std::min(count, fields.size()); ++k)
   {
      if (!fields[k].empty()) { x[k] = in.number(fields[k], "a number of *INSTANCE"); }
   }
   Block &block = *instances_.back();
   if (instance_lines_ == 1)
   {
      for (auto &[node, place] : block.deck.places)
      {
         place += Eigen::Vector2d(x[0], x[1]);
         if (x[2] != 0) { block.z[node] += x[2]; }
      }
      return;
   }
   const Eigen::Vector2d centre(x[0], x[1]);
   const double across = std::hypot(x[3] - x[0], x[4] - x[1]), up = x[5] - x[2];
   in.require(x[6] == 0 || across <= 1e-9 * std::abs(up),
              "the axis about which the *INSTANCE '", block.name,
              "' is turned has the direction (", x[3] - x[0], ", ", x[4] - x[1], ", ", up,
              "), must be along z: bodies are plane");
   constexpr double degree = 0.017453292519943295;
   const Eigen::Rotation2Dd turn((up < 0 ? -x[6] : x[6]) * degree);
   for (auto &[node, place] : block.deck.places)
   {
      place = centre + turn * (place - centre).eval();
   }
}

Block &DeckReader::home()
{
   if (part_) { return *part_; }
   const std::string instance = keyword_.parameter("INSTANCE");
   for (const auto &block : instances_)
   {
      if (block->name == instance) { return *block; }
   }
   // With a matrix there is one instance, and all numbers belong to it. The assembly of a mesh
   // may have points of its own.
   if (use_ == DeckUse::stiffness && instances_.size() == 1) { return *instances_[0]; }
   const bool only_part = parts_.size() == 1 && instances_.empty() && !whole_.has_nodes();
   return only_part ? parts_.begin()->second : whole_;
}

std::vector<Block *> DeckReader::blocks_of(const LineReader &in, std::string_view name)
{
   const std::string instance = keyword_.parameter("INSTANCE"), set = upper_case(name),
                     before = set.substr(0, std::min(set.rfind('.'), set.size()));
   if (part_) { return {part_}; }
   for (const auto &block : instances_)
   {
      if (block->name == instance || (instance.empty() && block->name == before))
      {
         return {block.get()};
      }
   }
   in.require(instance.empty() || instances_.empty(), "there is no *INSTANCE '", instance,
              "' before this line");
   std::vector<Block *> blocks{&home()};
   for (const auto &block : instances_)
   {
      if (block.get() != blocks[0]) { blocks.push_back(block.get()); }
   }
   return blocks;
}

void DeckReader::node(const LineReader &in, const std::vector<std::string_view> &fields)
{
   in.require(fields.size() >= 3, "*NODE has ", fields.size(),
              " fields, must have a number and two coordinates");
   // More fields are a direction of three numbers, or follow an empty z.
   in.require(fields.size() <= 4 || fields.size() == 7 || fields[3].empty(), "*NODE has ",
              fields.size(),
              " fields, must have a number, x, y and z, with points as decimal marks");
   const int number = in.integer(fields[0], "the number of a node");
   in.require(number > 0, "the number of a node is ", number, ", must be positive");
   const Eigen::Vector2d place(in.number(fields[1], "x of a node"),
                               in.number(fields[2], "y of a node"));
   const double z =
      fields.size() > 3 && !fields[3].empty() ? in.number(fields[3], "z of a node") : 0;
   Block &block = home();
   if (z != 0) { block.z[number] = z; }
   in.require(block.deck.places.emplace(number, place).second, "node ", number,
              " is there a second time, must be there once");
   const std::string set = keyword_.parameter("NSET");
   if (!set.empty()) { block.deck.node_sets[set].push_back(number); }
}

void DeckReader::elastic(const LineReader &in, const std::vector<std::string_view> &fields)
{
   if (unknown_materials_.count(material_)) { return; }
   // A second line is for another temperature.
   if (fields.size() < 2 || materials_.count(material_))
   {
      unknown_materials_.insert(material_);
      return;
   }
   materials_[material_] = {in.number(fields[0], "Young's modulus of *ELASTIC"),
                            in.number(fields[1], "Poisson's ratio of *ELASTIC")};
}

void DeckReader::element(LineReader &in)
{
   InputDeck::Element made;
   made.type = keyword_.parameter("TYPE");
   made.place = place(in);
   made.corners = corners_of(made.type);
   const std::size_t of_solid =
      use_ == DeckUse::mesh ? std::size_t(0) : nodes_of_solid(made.type);
   made.is_solid = of_solid > 0;
   in.add_integers(made.nodes, "a number of *ELEMENT");
   while (trimmed(in.line()).back() == ',' && in.next())
   {
      in.add_integers(made.nodes, "a number of *ELEMENT");
   }
   in.require(!made.type.empty(), "*ELEMENT has no TYPE, must have one, as TYPE=CPE4");
   if (made.nodes.empty()) { return; }
   made.number = made.nodes.front();
   made.nodes.erase(made.nodes.begin());
   Block &block = home();
   InputDeck &deck = block.deck;
   in.require(block.index.emplace(made.number, deck.elements.size()).second, "element ",
              made.number, " is there a second time, must be there once");
   const std::string set = keyword_.parameter("ELSET");
   if (!set.empty()) { deck.element_sets[set].push_back(deck.elements.size()); }
   in.require(made.corners != 2 || made.nodes.size() > 1, "element ", made.number, " is a ",
              made.type, " of one node, must have two or three");
   if (made.corners > 2 || made.is_solid)
   {
      const auto count =
         made.is_solid ? of_solid : static_cast<std::size_t>(made.type[3] - '0');
      in.require(made.nodes.size() == count, "element ", made.number, " is a ", made.type,
                 " of ", made.nodes.size(), " nodes, must have ", count);
      const Formulation formulation = made.is_solid         ? Formulation::space
                                      : made.type[1] == 'A' ? Formulation::axisymmetric
                                                            : Formulation::plane;
      in.require(!block.formulation || *block.formulation == formulation, "there are ",
                 name(block.formulation.value_or(formulation)), " elements and those of ",
                 made.type, ", must be of one kind: plane, axisymmetric or solid");
      block.formulation = formulation;
      for (int node : made.nodes)
      {
         in.require(deck.places.count(node) == 1, "element ", made.number, " has node ", node,
                    ", which *NODE does not name, it must be there before");
      }
   }
   deck.elements.push_back(std::move(made));
}

std::vector<DeckReader::In<int>> DeckReader::nodes_of(const LineReader &in,
                                                      std::string_view name)
{
   if (is_number(name)) { return {{&home(), {in.integer(name, "a node")}}}; }
   const std::string set = upper_case(name);
   std::vector<In<int>> found;
   for (Block *block : blocks_of(in, name))
   {
      const InputDeck &deck = block->deck;
      const auto its = block->find(deck.node_sets, set);
      const auto of_elements = block->find(deck.element_sets, set);
      const std::string number = Block::without_instance(set);
      if (its != deck.node_sets.end()) { found.push_back({block, its->second}); }
      else if (of_elements != deck.element_sets.end())
      {
         InputDeck::Nodes nodes;
         for (std::size_t e : of_elements->second)
         {
            nodes.insert(nodes.end(), deck.elements[e].nodes.begin(),
                         deck.elements[e].nodes.end());
         }
         found.push_back({block, nodes});
      }
      else if (is_number(number) && set == block->name + "." + number)
      {
         found.push_back({block, {in.integer(number, "a node")}});
      }
   }
   in.require(!found.empty(), "there is no set '", name, "' before this line");
   return found;
}

std::vector<int> DeckReader::nodes_of_one(const LineReader &in, std::string_view name)
{
   std::vector<int> all;
   for (const auto &[block, nodes] : nodes_of(in, name))
   {
      all.insert(all.end(), nodes.begin(), nodes.end());
   }
   return all;
}

std::vector<DeckReader::In<std::size_t>> DeckReader::elements_of(const LineReader &in,
                                                                 std::string_view name)
{
   const std::string set = upper_case(name), number = Block::without_instance(set);
   std::vector<In<std::size_t>> found;
   for (Block *block : blocks_of(in, name))
   {
      if (is_number(name) && block != &home()) { continue; }
      if (is_number(name) || (is_number(number) && set == block->name + "." + number))
      {
         const int element = in.integer(number, "an element");
         const auto place = block->index.find(element);
         in.require(place != block->index.end(), "there is no element ", element,
                    " before this line");
         return {{block, {place->second}}};
      }
      const auto its = block->find(block->deck.element_sets, set);
      if (its != block->deck.element_sets.end()) { found.push_back({block, its->second}); }
   }
   in.require(!found.empty(), "there is no element set '", name, "' before this line");
   return found;
}

template <class Has>
std::vector<int> DeckReader::generated(const LineReader &in,
                                       const std::vector<std::string_view> &fields,
                                       Has has) const
{
   in.require(fields.size() >= 2, "GENERATE has ", fields.size(),
              " numbers, must have the first, the last and a step");
   const int first = in.integer(fields[0], "the first number"),
             last = in.integer(fields[1], "the last number"),
             step = fields.size() > 2 ? in.integer(fields[2], "the step") : 1;
   in.require(step > 0 && first > 0 && last >= first && has(first) && has(last),
              "GENERATE from ", first, " to ", last, " by ", step, ", must be between ",
              keyword_.name == "NSET" ? "nodes" : "elements", " that are there, upwards");
   std::vector<int> numbers;
   for (long k = first; k <= last; k += step)
   {
      if (has(static_cast<int>(k))) { numbers.push_back(static_cast<int>(k)); }
   }
   return numbers;
}

void DeckReader::members(const LineReader &in, const std::vector<std::string_view> &fields)
{
   const std::string &kind = keyword_.name, set = keyword_.parameter(kind);
   in.require(!set.empty(), "*", kind, " has no name, must have ", kind, "=name");
   const bool list = keyword_.parameters.count("GENERATE") == 0;
   if (kind == "NSET")
   {
      std::vector<In<int>> some;
      if (list)
      {
         for (const std::string_view field : fields)
         {
            for (In<int> &more : nodes_of(in, field)) { some.push_back(std::move(more)); }
         }
      }
      else
      {
         const auto has = [&](int node) { return home().deck.places.count(node) == 1; };
         some.push_back({&home(), generated(in, fields, has)});
      }
      for (const auto &[block, nodes] : some)
      {
         InputDeck::Nodes &members = block->deck.node_sets[set];
         members.insert(members.end(), nodes.begin(), nodes.end());
      }
      return;
   }
   std::vector<In<std::size_t>> some;
   if (list)
   {
      for (const std::string_view field : fields)
      {
         for (auto &more : elements_of(in, field)) { some.push_back(std::move(more)); }
      }
   }
   else
   {
      Block &block = home();
      const auto has = [&](int element) { return block.index.count(element) == 1; };
      some.push_back({&block, {}});
      for (int e : generated(in, fields, has))
      {
         some.back().members.push_back(block.index.at(e));
      }
   }
   for (const auto &[block, elements] : some)
   {
      std::vector<std::size_t> &members = block->deck.element_sets[set];
      members.insert(members.end(), elements.begin(), elements.end());
   }
}

void DeckReader::surface(const LineReader &in, const std::vector<std::string_view> &fields)
{
   const std::string type = keyword_.parameter("TYPE"), name = keyword_.parameter("NAME");
   if (type == "NODE")
   {
      for (const auto &[block, nodes] : nodes_of(in, fields[0]))
      {
         InputDeck::Nodes &members = block->deck.node_sets[name];
         members.insert(members.end(), nodes.begin(), nodes.end());
      }
   }
   // Analytical surfaces and combinations of surfaces are not parts of a body.
   if ((type != "ELEMENT" && !type.empty()) || !keyword_.parameter("COMBINE").empty())
   {
      return;
   }
   int side = -1;
   if (fields.size() > 1)
   {
      const std::string label = upper_case(fields[1]);
      in.require(label.size() == 2 && label[0] == 'S' && label[1] >= '1' && label[1] <= '6',
                 "face '", fields[1], "' of surface '", name,
                 "', must be S1 to S4, of solids to S6");
      side = label[1] - '1';
   }
   for (const auto &[block, elements] : elements_of(in, fields[0]))
   {
      for (std::size_t e : elements) { block->faces.push_back({name, place(in), e, side}); }
   }
}

/// Keeps only the elements of a set, with the sets and surfaces that name them and their nodes.
void keep_elements(Block &block, const std::vector<std::size_t> &kept)
{
   InputDeck &deck = block.deck;
   std::map<std::size_t, std::size_t> place; // of elements that are kept
   std::vector<InputDeck::Element> elements;
   std::set<int> nodes;
   for (std::size_t e : kept)
   {
      if (!place.emplace(e, elements.size()).second) { continue; }
      nodes.insert(deck.elements[e].nodes.begin(), deck.elements[e].nodes.end());
      elements.push_back(deck.elements[e]);
   }
   // Lines that name a part of the boundary go with the elements along them.
   for (std::size_t e = 0; e < deck.elements.size(); ++e)
   {
      const InputDeck::Element &line = deck.elements[e];
      const auto of_it = [&](int node) { return nodes.count(node) == 1; };
      if (line.corners != 2 || !std::all_of(line.nodes.begin(), line.nodes.end(), of_it) ||
          !place.emplace(e, elements.size()).second)
      {
         continue;
      }
      elements.push_back(line);
   }
   deck.elements = std::move(elements);
   for (auto set = deck.element_sets.begin(); set != deck.element_sets.end();)
   {
      std::vector<std::size_t> left;
      for (std::size_t e : set->second)
      {
         if (place.count(e)) { left.push_back(place.at(e)); }
      }
      set->second = left;
      set = left.empty() ? deck.element_sets.erase(set) : std::next(set);
   }
   for (auto set = deck.node_sets.begin(); set != deck.node_sets.end();)
   {
      InputDeck::Nodes &its = set->second;
      its.erase(std::remove_if(its.begin(), its.end(),
                               [&](int node) { return nodes.count(node) == 0; }),
                its.end());
      set = its.empty() ? deck.node_sets.erase(set) : std::next(set);
   }
   for (auto at = deck.places.begin(); at != deck.places.end();)
   {
      at = nodes.count(at->first) ? std::next(at) : deck.places.erase(at);
   }
   std::vector<Face> faces;
   for (Face &face : block.faces)
   {
      if (place.count(face.element) == 0) { continue; }
      face.element = place.at(face.element);
      faces.push_back(face);
   }
   block.faces = std::move(faces);
}

Block &DeckReader::chosen(const std::string &file, const DeckPart &part)
{
   const std::string asked = upper_case(part.name), usual = upper_case(part.usual);
   std::vector<Block *> blocks;
   for (const auto &block : instances_) { blocks.push_back(block.get()); }
   if (blocks.empty() && whole_.has_nodes()) { blocks.push_back(&whole_); }
   for (auto &[name, block] : parts_)
   {
      if (instances_.empty() && block.has_nodes()) { blocks.push_back(&block); }
   }
   require(!blocks.empty(), "file '", file,
           "': there is no *NODE, a deck must have one (a mesh of Gmsh must be called .msh)");
   std::vector<std::string> names;
   for (Block *block : blocks)
   {
      if (!block->name.empty()) { names.push_back(block->name); }
      if (!asked.empty() && block->name == asked) { return *block; }
   }
   if (!asked.empty())
   {
      std::vector<std::string> sets;
      for (Block *block : blocks)
      {
         const auto set = block->find(block->deck.element_sets, asked);
         if (set != block->deck.element_sets.end())
         {
            keep_elements(*block, std::vector<std::size_t>(set->second));
            return *block;
         }
         for (const auto &each : block->deck.element_sets)
         {
            // CAE makes sets of its own for the sides of surfaces, such as _HIT_S4.
            const std::string own = each.first.substr(each.first.find('.') + 1);
            if (own.empty() || own[0] != '_') { sets.push_back(each.first); }
         }
      }
      names.insert(names.end(), sets.begin(), sets.end());
      require(false, "file '", file, "' has no instance and no set of elements '", part.name,
              "', must be one of: ", listed(names));
   }
   for (Block *block : blocks)
   {
      if (blocks.size() > 1 && !usual.empty() && block->name == usual) { return *block; }
   }
   require(blocks.size() == 1, "file '", file, "' has ", blocks.size(), " ",
           instances_.empty() ? "parts" : "instances", ", ", listed(names),
           ": each body must name one of them (key 'part')");
   return *blocks[0];
}

/// Sets of an instance get their own names back, unless the assembly has a set with the same
/// name.
void tidy(Block &block)
{
   const auto tidy_sets = [&](auto &sets)
   {
      const std::string before = block.name + ".";
      auto all = std::move(sets);
      sets.clear();
      for (auto &[name, members] : all)
      {
         drop_repeated(members);
         const std::string plain =
            name.rfind(before, 0) == 0 ? name.substr(before.size()) : name;
         sets[plain == name || all.count(plain) == 0 ? plain : name] = std::move(members);
      }
   };
   tidy_sets(block.deck.node_sets);
   tidy_sets(block.deck.element_sets);
   tidy_sets(block.deck.surfaces);
}

/// Third coordinates, outer faces and surfaces of a block of solids.
void finish_in_space(const std::string &file, Block &block)
{
   InputDeck &deck = block.deck;
   for (const auto &[node, at] : deck.places)
   {
      const auto found = block.z.find(node);
      deck.z[node] = found == block.z.end() ? 0 : found->second;
   }
   const auto place = [&deck](int node)
   {
      const Eigen::Vector2d &at = deck.places.at(node);
      return Eigen::Vector3d(at[0], at[1], deck.z.at(node));
   };
   std::vector<InputDeck::Nodes> solids;
   std::vector<int> numbers;
   for (const InputDeck::Element &element : deck.elements)
   {
      if (!element.is_solid) { continue; }
      solids.push_back(element.nodes);
      numbers.push_back(element.number);
   }
   const auto corners_of_face = [](const InputDeck::Nodes &face)
   {
      InputDeck::Nodes corners(face.begin(),
                               face.begin() + (face.size() == 3 || face.size() == 6 ? 3 : 4));
      std::sort(corners.begin(), corners.end());
      return corners;
   };
   std::map<InputDeck::Nodes, const InputDeck::Nodes *> outer;
   try
   {
      deck.faces = outer_faces(solids, place, numbers);
   }
   catch (const InputError &error)
   {
      throw InputError("file '" + file + "': " + error.what());
   }
   for (const InputDeck::Nodes &face : deck.faces) { outer[corners_of_face(face)] = &face; }
   for (const Face &face : block.faces)
   {
      const InputDeck::Element &element = deck.elements[face.element];
      std::vector<InputDeck::Nodes> &its = deck.surfaces[face.surface];
      const std::vector<InputDeck::Nodes> all =
         element.is_solid ? faces_of(element.nodes) : std::vector<InputDeck::Nodes>();
      require(face.side < static_cast<int>(all.size()), face.place, ": surface '", face.surface,
              "' has face S", face.side + 1, " of element ", element.number, ", a ",
              element.type, ", which has none");
      for (int k = 0; k < static_cast<int>(all.size()); ++k)
      {
         if (face.side >= 0 && face.side != k) { continue; }
         const auto found = outer.find(corners_of_face(all[k]));
         require(face.side < 0 || found != outer.end(), face.place, ": face S", k + 1,
                 " of element ", element.number, " of surface '", face.surface,
                 "' is inside of the body, must be on its boundary");
         if (found != outer.end()) { its.push_back(*found->second); }
      }
   }
   tidy(block);
}

InputDeck DeckReader::finish(const std::string &file, const DeckPart &part)
{
   Block &block = chosen(file, part);
   InputDeck &deck = block.deck;
   deck.formulation = block.formulation.value_or(is_axisymmetric_ ? Formulation::axisymmetric
                                                                  : Formulation::plane);
   deck.keywords = std::move(keywords_);
   deck.cards = std::move(cards_);
   for (const auto &[name, material] : materials_)
   {
      if (unknown_materials_.count(name) == 0) { deck.materials[name] = material; }
   }
   std::vector<InputDeck::Nodes> plane;
   std::vector<int> numbers, used;
   if (deck.formulation == Formulation::space)
   {
      finish_in_space(file, block);
      return std::move(deck);
   }
   for (const InputDeck::Element &element : deck.elements)
   {
      used.insert(used.end(), element.nodes.begin(), element.nodes.end());
      if (element.corners < 3) { continue; }
      plane.push_back(element.nodes);
      numbers.push_back(element.number);
   }
   if (used.empty())
   {
      for (const auto &node : deck.places) { used.push_back(node.first); }
   }
   std::vector<Eigen::Vector3d> places;
   for (int node : used)
   {
      const auto at = deck.places.find(node);
      const auto z = block.z.find(node);
      if (at == deck.places.end()) { continue; }
      places.emplace_back(at->second[0], at->second[1], z == block.z.end() ? 0 : z->second);
   }
   if (const std::optional<std::size_t> off = first_off_plane(places))
   {
      require(
         false, "file '", file, "': node ", used[*off], " is at z = ", rounded(places[*off][2]),
         ", the first one at ", rounded(places[0][2]),
         ", all must be in one plane z = const: bodies are plane, turn the mesh into the xy "
         "plane and leave solid elements out");
   }
   try
   {
      deck.edges = outer_edges(plane, deck.places, numbers);
   }
   catch (const InputError &error)
   {
      throw InputError("file '" + file + "': " + error.what());
   }
   std::map<std::pair<int, int>, const InputDeck::Nodes *> outer;
   for (const InputDeck::Nodes &edge : deck.edges)
   {
      outer[std::minmax(edge.front(), edge.back())] = &edge;
   }
   for (const Face &face : block.faces)
   {
      const InputDeck::Element &element = deck.elements[face.element];
      std::vector<InputDeck::Nodes> &edges = deck.surfaces[face.surface];
      const auto corners = static_cast<int>(element.corners);
      require(corners > 2 && face.side < corners, face.place, ": surface '", face.surface,
              "' has face S", face.side + 1, " of element ", element.number, ", but a ",
              element.type, " has no such face");
      for (int k = 0; k < corners; ++k)
      {
         if (face.side >= 0 && face.side != k) { continue; }
         const auto found =
            outer.find(std::minmax(element.nodes[k], element.nodes[(k + 1) % corners]));
         require(face.side < 0 || found != outer.end(), face.place, ": face S", k + 1,
                 " of element ", element.number, " of surface '", face.surface,
                 "' is not on the boundary of the body, must be");
         if (found != outer.end()) { edges.push_back(*found->second); }
      }
   }
   tidy(block);
   return std::move(deck);
}

void DeckReader::load(const LineReader &in, const std::vector<std::string_view> &fields)
{
   in.require(fields.size() >= 3, "*CLOAD has ", fields.size(),
              " fields, must have a node or set, a direction and a force");
   const int direction = in.integer(fields[1], "the direction of a force");
   const double force = in.number(fields[2], "a force");
   for (int node : nodes_of_one(in, fields[0]))
   {
      cards_.back().values.push_back({{node, direction}, force});
   }
}

void DeckReader::support(const LineReader &in, const std::vector<std::string_view> &fields)
{
   in.require(fields.size() >= 2, "*BOUNDARY has ", fields.size(),
              " fields, must have a node or set and a direction");
   static const std::map<std::string, std::array<int, 2>> words = {{"ENCASTRE", {1, 2}},
                                                                   {"PINNED", {1, 2}},
                                                                   {"XSYMM", {1, 1}},
                                                                   {"YSYMM", {2, 2}},
                                                                   {"ZSYMM", {3, 3}}};
   const auto word = words.find(upper_case(fields[1]));
   std::array<int, 2> directions{};
   double value = 0;
   if (word != words.end()) { directions = word->second; }
   else
   {
      directions.fill(in.integer(fields[1], "the direction of a support"));
      if (fields.size() > 2 && !fields[2].empty())
      {
         directions[1] = in.integer(fields[2], "the last direction of a support");
      }
      if (fields.size() > 3) { value = in.number(fields[3], "a displacement"); }
   }
   in.require(directions[0] >= 1, "the direction of a support is ", directions[0],
              ", must be at least 1");
   // A plane body does not move across its plane, and a solid has no rotations.
   const bool in_space = home().formulation == Formulation::space;
   if (in_space && word != words.end())
   {
      directions = word->first == "ZSYMM"                     ? std::array<int, 2>{3, 3}
                   : directions[1] == 2 && directions[0] == 1 ? std::array<int, 2>{1, 3}
                                                              : directions;
   }
   for (int node : nodes_of_one(in, fields[0]))
   {
      for (int d = directions[0]; d <= std::min(directions[1], in_space ? 3 : 2); ++d)
      {
         cards_.back().values.push_back({{node, d}, value});
      }
   }
}

} // namespace

InputDeck read_input_deck(const std::string &file, DeckUse use, const DeckPart &part)
{
   DeckReader reader(use);
   reader.read(file, 0);
   return reader.finish(file, part);
}

} // namespace cattaneo

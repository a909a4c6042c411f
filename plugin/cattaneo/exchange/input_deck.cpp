#include <algorithm>
#include <cattaneo/exchange/input_deck.hpp>
#include <cattaneo/exchange/line_reader.hpp>
#include <cattaneo/exchange/outer_edges.hpp>
#include <filesystem>
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

/// A plane or axisymmetric element by its type in capitals: CPE4, CAX8R, S…; none of another.
struct PlaneElement
{
   Formulation formulation;
   std::size_t nodes;

   static std::optional<PlaneElement> of(const std::string &type)
   {
      const std::string family = type.substr(0, 3);
      const std::size_t nodes = type.size() > 3 ? static_cast<std::size_t>(type[3] - '0') : 0;
      const bool known = family == "CPE" || family == "CPS" || family == "CAX";
      if (!known || (nodes != 3 && nodes != 4 && nodes != 6 && nodes != 8)) { return {}; }
      return PlaneElement{family == "CAX" ? Formulation::axisymmetric : Formulation::plane,
                          nodes};
   }
};

class DeckReader
{
public:
   explicit DeckReader(NodalStiffness &body) : body_(body) {}
   std::vector<Card> cards;
   std::vector<NodalStiffness::Nodes> elements; ///< that have edges

   void read(const std::string &file, int depth);

private:
   void begin(LineReader &in, int depth);
   void data(LineReader &in);
   void node(const LineReader &in, const std::vector<std::string_view> &fields);
   void element(LineReader &in);
   void members(const LineReader &in, const std::vector<std::string_view> &fields);
   void load(const LineReader &in, const std::vector<std::string_view> &fields);
   void support(const LineReader &in, const std::vector<std::string_view> &fields);
   NodalStiffness::Nodes nodes_of(const LineReader &in, std::string_view name) const;
   void put(const std::string &set, int node)
   {
      if (!set.empty()) { body_.sets[set].push_back(node); }
   }

   NodalStiffness &body_;
   Keyword keyword_;
   int parts_ = 0, loads_ = 0, displacements_ = 0;
   std::optional<Formulation> formulation_;
};

/// A set that is named or listed several times has each node once, in the order of the file.
void drop_repeated(NodalStiffness::Nodes &nodes)
{
   std::set<int> seen;
   const auto again = [&](int node) { return !seen.insert(node).second; };
   nodes.erase(std::remove_if(nodes.begin(), nodes.end(), again), nodes.end());
}

void DeckReader::read(const std::string &file, int depth)
{
   LineReader in(file);
   keyword_ = {};
   while (in.next())
   {
      const std::string_view line = trimmed(in.line());
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
      read((std::filesystem::path(in.file()).parent_path() / file).string(), depth + 1);
      keyword_ = {};
   }
   in.require(name != "TRANSFORM", "*TRANSFORM turns directions of nodes, must be left out: "
                                   "matrices are read in x and y");
   static const std::set<std::string> couplings = {"EQUATION",
                                                   "MPC",
                                                   "RIGID BODY",
                                                   "COUPLING",
                                                   "KINEMATIC",
                                                   "DISTRIBUTING",
                                                   "DISTRIBUTING COUPLING",
                                                   "KINEMATIC COUPLING",
                                                   "TIE",
                                                   "CONTACT PAIR",
                                                   "CYCLIC SYMMETRY MODEL"};
   in.require(couplings.count(name) == 0, "*", name,
              " makes nodes depend on others, whose rows "
              "are not their own then, must be left out");
   parts_ += name == "PART";
   in.require(parts_ < 2, "a second *PART begins, there must be one: node numbers of several "
                          "are not told apart");
   if (name == "CLOAD")
   {
      cards.push_back({"CLOAD" + std::to_string(++loads_), Control::force, {}});
   }
   if (name == "BOUNDARY")
   {
      cards.push_back(
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
   else if (name == "NSET") { members(in, fields); }
   else if (name == "CLOAD") { load(in, fields); }
   else if (name == "BOUNDARY") { support(in, fields); }
   else if (name == "INSTANCE")
   {
      in.require(false, "an instance is moved, must be where its part is");
   }
   else if (name == "SOLID SECTION" && !fields[0].empty())
   {
      const double thickness = in.number(fields[0], "the thickness of *SOLID SECTION");
      in.require(thickness == 1, "the thickness of *SOLID SECTION is ", thickness,
                 ", must be 1: everything is per unit thickness");
   }
}

void DeckReader::node(const LineReader &in, const std::vector<std::string_view> &fields)
{
   in.require(fields.size() >= 3, "*NODE has ", fields.size(),
              " fields, must have a number and two coordinates");
   const int number = in.integer(fields[0], "the number of a node");
   in.require(number > 0, "the number of a node is ", number, ", must be positive");
   const Eigen::Vector2d place(in.number(fields[1], "x of a node"),
                               in.number(fields[2], "y of a node"));
   const double z =
      fields.size() > 3 && !fields[3].empty() ? in.number(fields[3], "z of a node") : 0;
   in.require(z == 0, "node ", number, " is at z = ", z, ", must be in the plane z = 0");
   in.require(body_.places.emplace(number, place).second, "node ", number,
              " is there a second time, must be there once");
   put(keyword_.parameter("NSET"), number);
}

void DeckReader::element(LineReader &in)
{
   const std::string &type = keyword_.parameters["TYPE"];
   const std::optional<PlaneElement> shape = PlaneElement::of(type);
   std::vector<int> nodes;
   in.add_integers(nodes, "a number of *ELEMENT");
   while (trimmed(in.line()).back() == ',' && in.next())
   {
      in.add_integers(nodes, "a number of *ELEMENT");
   }
   if (nodes.empty()) { return; }
   nodes.erase(nodes.begin()); // the element's own number
   for (int node : nodes) { put(keyword_.parameter("ELSET"), node); }
   if (!shape) { return; } // springs and whatever else has no outer edges
   in.require(nodes.size() == shape->nodes, "an element ", type, " has ", nodes.size(),
              " nodes, must have ", shape->nodes);
   in.require(!formulation_ || *formulation_ == shape->formulation,
              "there are plane and axisymmetric elements, must be of one kind");
   formulation_ = body_.formulation = shape->formulation;
   for (int node : nodes)
   {
      in.require(body_.places.count(node) == 1, "an element has node ", node,
                 ", which *NODE does not name, it must be there before");
   }
   elements.push_back(nodes);
}

NodalStiffness::Nodes DeckReader::nodes_of(const LineReader &in, std::string_view name) const
{
   if (!name.empty() && std::isdigit(static_cast<unsigned char>(name[0])))
   {
      return {in.integer(name, "a node")};
   }
   const std::string_view plain = name.substr(std::min(name.rfind('.') + 1, name.size()));
   const auto found = body_.sets.find(upper_case(plain)); // "instance.set"
   in.require(found != body_.sets.end(), "there is no set '", name, "' before this line");
   return found->second;
}

void DeckReader::members(const LineReader &in, const std::vector<std::string_view> &fields)
{
   const std::string set = keyword_.parameter("NSET");
   in.require(!set.empty(), "*NSET has no name, must have NSET=name");
   if (keyword_.parameters.count("GENERATE") == 0)
   {
      for (const std::string_view field : fields)
      {
         for (int node : nodes_of(in, field)) { put(set, node); }
      }
      return;
   }
   in.require(fields.size() >= 2, "GENERATE has ", fields.size(),
              " numbers, must have the first, the last and a step");
   const int first = in.integer(fields[0], "the first node"),
             last = in.integer(fields[1], "the last node"),
             step = fields.size() > 2 ? in.integer(fields[2], "the step") : 1;
   in.require(step > 0 && first > 0 && last >= first &&
                 body_.places.count(first) + body_.places.count(last) == 2,
              "GENERATE from node ", first, " to ", last, " by ", step,
              ", must be between nodes that are there, upwards");
   for (long node = first; node <= last; node += step) { put(set, static_cast<int>(node)); }
}

void DeckReader::load(const LineReader &in, const std::vector<std::string_view> &fields)
{
   in.require(fields.size() >= 3, "*CLOAD has ", fields.size(),
              " fields, must have a node or set, a direction and a force");
   const int direction = in.integer(fields[1], "the direction of a force");
   const double force = in.number(fields[2], "a force");
   for (int node : nodes_of(in, fields[0]))
   {
      cards.back().values.push_back({{node, direction}, force});
   }
}

void DeckReader::support(const LineReader &in, const std::vector<std::string_view> &fields)
{
   in.require(fields.size() >= 2, "*BOUNDARY has ", fields.size(),
              " fields, must have a node or set and a direction");
   static const std::map<std::string, std::array<int, 2>> words = {
      {"ENCASTRE", {1, 2}}, {"PINNED", {1, 2}}, {"XSYMM", {1, 1}}, {"YSYMM", {2, 2}}};
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
   for (int node : nodes_of(in, fields[0]))
   {
      // Across the plane nothing moves.
      for (int d = directions[0]; d <= std::min(directions[1], 2); ++d)
      {
         cards.back().values.push_back({{node, d}, value});
      }
   }
}

} // namespace

std::vector<Card> read_input_deck(const std::string &file, NodalStiffness &body)
{
   DeckReader reader(body);
   reader.read(file, 0);
   require(!body.places.empty(), "file '", file, "': there is no *NODE, must be");
   body.edges = outer_edges(reader.elements, body.places);
   for (auto &[name, nodes] : body.sets) { drop_repeated(nodes); }
   return std::move(reader.cards);
}

} // namespace cattaneo

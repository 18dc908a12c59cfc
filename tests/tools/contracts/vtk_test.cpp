// ./drumlin vtk on dumps written by hand: its files, and its messages on files that are no dumps.
#include "tests/support/run_folders.h"
#include "tests/support/tool.h"
#include "bed/coarse_graining.h"
#include "bed/dump_readers.h"
#include "support/process.h"

#include <nlohmann/json.hpp>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

class VtkCommand : public Tool {
protected:
  VtkCommand() {
    put("run/parameters.csv", "name,value\ndeck,bed\ntimestep,0.125\n");
    for (const char *step : {"0", "1000", "200"}) {
      put(std::string("run/dump/balls_") + step + ".vtp", ball_dump());
      put(std::string("run/dump/contacts_") + step + ".dump", contact_dump());
      put(std::string("run/dump/balls_boundingBox_") + step + ".vtr", "of no interest");
    }
  }

  void put(const std::string &file, const std::string &text) const {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << text;
  }
  Outcome run(const std::vector<std::string> &words) const { return drumlin("vtk", words); }
  /// Every file below a folder, with its text.
  std::map<std::string, std::string> files(const std::string &name) const {
    std::map<std::string, std::string> texts;
    if (fs::exists(folder_ / name))
      for (const auto &entry : fs::recursive_directory_iterator(folder_ / name))
        texts[entry.path().lexically_relative(folder_ / name).string()] =
            entry.is_directory() ? "(folder)" : read_text(entry.path());
    return texts;
  }
  std::vector<std::string> names(const std::string &name) const {
    std::vector<std::string> all;
    for (const auto &file : files(name))
      all.push_back(file.first);
    return all;
  }
};

TEST_F(VtkCommand, WritesThreeCollections) {
  const Outcome outcome = well(run({"run"}));
  EXPECT_EQ(
      names("run/vtk"),
      (std::vector<std::string>{"balls.pvd", "balls_0.vtp", "balls_1000.vtp", "balls_200.vtp", "contacts.pvd",
                                "contacts_0.vtp", "contacts_1000.vtp", "contacts_200.vtp", "fields.pvd",
                                "fields_0.vti", "fields_1000.vti", "fields_200.vti", "scene.json"}));
  EXPECT_EQ(read_text(folder_ / "run/vtk/fields.pvd"),
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"Collection\" version=\"0.1\">\n"
            "  <Collection>\n"
            "    <DataSet timestep=\"0\" file=\"fields_0.vti\"/>\n"
            "    <DataSet timestep=\"25\" file=\"fields_200.vti\"/>\n"
            "    <DataSet timestep=\"125\" file=\"fields_1000.vti\"/>\n"
            "  </Collection>\n"
            "</VTKFile>\n");
  EXPECT_TRUE(printed(outcome, "run/vtk/contacts.pvd: 3 steps, 0 to 125 s\n"));
}

// Longer than other tests: it goes through every array of the three files of a step.
TEST_F(VtkCommand, WritesWhatTheDumpsHold) {
  well(run({"run", "--cell", "4", "--out", "new/here"}));
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder_ / "new/here/balls_200.vtp").c_str());
  reader->Update();
  vtkPointData *balls = reader->GetOutput()->GetPointData();
  ASSERT_EQ(reader->GetOutput()->GetNumberOfPoints(), 3);
  const auto column = [&balls](const char *name) {
    std::vector<double> values;
    vtkDataArray *array = balls->GetArray(name);
    for (vtkIdType row = 0; row < array->GetNumberOfTuples(); ++row)
      for (int c = 0; c < array->GetNumberOfComponents(); ++c)
        values.push_back(array->GetComponent(row, c));
    return values;
  };
  using Values = std::vector<double>;
  EXPECT_EQ(column("id"), (Values{1, 2, 9}));
  EXPECT_EQ(column("type"), (Values{1, 1, 2}));
  EXPECT_EQ(column("radius"), (Values{1, 1, 2}));
  EXPECT_EQ(column("diameter"), (Values{2, 2, 4}));
  EXPECT_EQ(column("mass"), (Values{10, 20, 500}));
  EXPECT_EQ(column("velocity"), (Values{3, 0, 0, 0, 6, 0, 0, 0, 0}));
  EXPECT_EQ(column("angular_velocity"), (Values{0, 0, 1, 0, 0, 2, 0, 0, 0}));
  EXPECT_EQ(column("force"), (Values{1, 2, 3, 0, 0, 0, 0, 7, 0}));
  EXPECT_EQ(column("coordination"), (Values{2, 1, 1}));
  const double by_hand = 100 * 0.9 + 400 * 0.95 + 430 * 0.95; // ball 1: its neighbour, the drum, the floor
  const Values pressure = column("pressure");
  EXPECT_NEAR(pressure[0], by_hand / (2.0 * 3.141592653589793), 1e-9);
  EXPECT_EQ(reader->GetOutput()->GetNumberOfVerts(), 3); // or ParaView shows nothing

  vtkNew<vtkXMLPolyDataReader> lines;
  lines->SetFileName((folder_ / "new/here/contacts_200.vtp").c_str());
  lines->Update();
  ASSERT_EQ(lines->GetOutput()->GetNumberOfLines(), 3);
  vtkCellData *contacts = lines->GetOutput()->GetCellData();
  const auto row = [&contacts](const char *name, vtkIdType contact) {
    const double *tuple = contacts->GetArray(name)->GetTuple(contact);
    return Values(tuple, tuple + contacts->GetArray(name)->GetNumberOfComponents());
  };
  EXPECT_EQ(row("id1", 0), (Values{1}));
  EXPECT_EQ(row("id2", 0), (Values{2}));
  EXPECT_EQ(row("force", 0), (Values{-100, -30, 0})); // on ball 1, by its neighbour on the right
  EXPECT_DOUBLE_EQ(row("normal_force", 0)[0], 100);
  EXPECT_DOUBLE_EQ(row("tangential_force", 0)[0], 30);
  EXPECT_EQ(row("overlap", 0), (Values{0.2}));
  EXPECT_EQ(row("id2", 1), (Values{9}));
  EXPECT_DOUBLE_EQ(row("normal_force", 1)[0], 400);
  EXPECT_NEAR(row("tangential_force", 1)[0], 0.0, 1e-12);
  EXPECT_EQ(row("id1", 2), (Values{1})); // on the floor
  EXPECT_EQ(row("id2", 2), (Values{0}));
  EXPECT_EQ(row("force", 2), (Values{5, 430, 0}));
  EXPECT_DOUBLE_EQ(row("normal_force", 2)[0], 430);
  EXPECT_DOUBLE_EQ(row("tangential_force", 2)[0], 5);
  EXPECT_EQ(row("overlap", 2), (Values{0.05}));
  double end[3];
  lines->GetOutput()->GetPoint(1, end);
  EXPECT_FLOAT_EQ(static_cast<float>(end[0]), 2.8F);
  lines->GetOutput()->GetPoint(5, end);
  EXPECT_NEAR(end[0], 1.0, 1e-6);
  EXPECT_NEAR(end[1], 0.05, 1e-6); // radius 1 and overlap 0.05 below the centre at 1

  vtkNew<vtkXMLImageDataReader> image;
  image->SetFileName((folder_ / "new/here/fields_200.vti").c_str());
  image->Update();
  ASSERT_EQ(image->GetOutput()->GetNumberOfCells(), 1); // of 3.8 m by 2 m: soil alone
  vtkCellData *fields = image->GetOutput()->GetCellData();
  const double area = 3.8 * 2.0;
  EXPECT_NEAR(fields->GetArray("solid_fraction")->GetTuple1(0), 2.0 * 3.141592653589793 / area, 1e-6);
  EXPECT_NEAR(fields->GetArray("bulk_density")->GetTuple1(0), 30.0 / area, 1e-6);
  EXPECT_NEAR(fields->GetArray("velocity")->GetComponent(0, 0), 1.0, 1e-14);
  EXPECT_NEAR(fields->GetArray("velocity")->GetComponent(0, 1), 4.0, 1e-14);
  EXPECT_NEAR(fields->GetArray("stress")->GetComponent(0, 0), 100.0 * 1.8 / area, 1e-5); // f_x l_x
  EXPECT_NEAR(fields->GetArray("stress")->GetComponent(0, 3), 30.0 * 1.8 / area, 1e-5);  // f_y l_x
  EXPECT_NEAR(fields->GetArray("stress")->GetComponent(0, 4), 0.0, 1e-12); // the drum's is not soil's
  EXPECT_NEAR(fields->GetArray("pressure")->GetTuple1(0), 50.0 * 1.8 / area, 1e-5);
  EXPECT_NEAR(fields->GetArray("fabric")->GetComponent(0, 0), 1.0, 1e-14);
  EXPECT_NEAR(fields->GetArray("coordination")->GetTuple1(0), 1.0, 1e-14);
  EXPECT_EQ(fields->GetArray("relative_density"), nullptr); // the run does not note its loosest packing
}

// Two discs of radius 1 m take 2 pi of 3.8 m by 2 m.
TEST_F(VtkCommand, WritesTheRelativeDensityOfALayer) {
  put("run/parameters.csv", "name,value\ntimestep,0.125\nlayer_tops,\"-5,9\"\ne_loosest,\"0.1,0.3\"\n"
                            "e_shaken,\"0.05,0.2\"\n");
  well(run({"run", "--cell", "4", "--out", "new"}));
  vtkNew<vtkXMLImageDataReader> image;
  image->SetFileName((folder_ / "new/fields_200.vti").c_str());
  image->Update();
  vtkCellData *fields = image->GetOutput()->GetCellData();
  const double solid = 2.0 * 3.141592653589793 / (3.8 * 2.0);
  ASSERT_NE(fields->GetArray("relative_density"), nullptr);
  EXPECT_NEAR(fields->GetArray("relative_density")->GetTuple1(0), (0.3 - (1.0 / solid - 1.0)) / 0.1, 1e-5);
  EXPECT_NEAR(fields->GetArray("compaction")->GetTuple1(0), solid * 1.2, 1e-6);
}

// A quarter of a turn into the second cycle of 20 s. Contacts push the drum up by 400 N.
TEST_F(VtkCommand, WritesThePhaseAndTheForcesOnTheDrum) {
  put("run/parameters.csv", "name,value\ntimestep,0.125\nomega,0.31415926535897931\nFw,1000\n");
  well(run({"run"}));
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder_ / "run/vtk/balls_200.vtp").c_str());
  reader->Update();
  const auto value = [&reader](const char *name) {
    return reader->GetOutput()->GetFieldData()->GetArray(name)->GetTuple1(0);
  };
  EXPECT_EQ(value("cycle"), 2.0);
  EXPECT_NEAR(value("phase"), 90.0, 1e-6);
  EXPECT_NEAR(value("F_excitation"), 1000.0, 1e-9);
  EXPECT_EQ(value("F_contact"), 400.0);
}

// The colour scale of a picture: the 99 % quantile leaves out the single fast soil ball of 6 m/s, and the
// drum is not part of it at all.
// Of a roller that drives, from the row of bed.csv of the same time; the last dump is behind its last row.
TEST_F(VtkCommand, WritesPlaceAndPassOfARollerThatDrives) {
  put("run/parameters.csv", "name,value\ndeck,drive\ntimestep,0.125\n");
  std::string text = "time,s,pass,traction,work_excitation,work_traction,work_torque\n";
  for (int row = 0; row <= 24; ++row)
    text += fmt::format("{},{},{},0,0,0,0\n", 5 * row, -1.0 + 0.1 * row, row < 4 ? 1 : 2);
  put("run/bed.csv", text + "125,1.");
  ASSERT_TRUE(run({"run"}).ok());
  const auto value = [&](int step, const char *name) {
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName((folder_ / fmt::format("run/vtk/balls_{}.vtp", step)).c_str());
    reader->Update();
    vtkDataArray *array = reader->GetOutput()->GetFieldData()->GetArray(name);
    return array == nullptr ? std::nullopt : std::optional(array->GetTuple1(0));
  };
  EXPECT_EQ(value(0, "s"), -1.0);
  EXPECT_EQ(value(0, "pass_number"), 1.0);
  EXPECT_NEAR(value(200, "s").value(), -0.5, 1e-12); // 25 s
  EXPECT_EQ(value(200, "pass_number"), 2.0);
  EXPECT_EQ(value(1000, "s"), std::nullopt); // 125 s
}

TEST_F(VtkCommand, WritesTheRangesOfTheValues) {
  put("run/parameters.csv", "name,value\ntimestep,0.125\nomega,0.31415926535897931\n");
  well(run({"run"}));
  const nlohmann::json scene = nlohmann::json::parse(read_text(folder_ / "run/vtk/scene.json"));
  EXPECT_EQ(scene["dimension"], 2);
  EXPECT_NEAR(scene["period"].get<double>(), 20.0, 1e-12);
  EXPECT_EQ(scene["sizes"]["velocity"]["quantile_99"], 3.0);
  EXPECT_EQ(scene["sizes"]["velocity"]["largest"], 6.0);
  EXPECT_EQ(scene["sizes"]["coordination"]["largest"], 2.0);
  EXPECT_EQ(scene["sizes"]["normal_force"]["largest"], 430.0);
  EXPECT_NEAR(scene["bounds"][1][1].get<double>(), 5.9, 1e-6); // top of the drum
  ASSERT_EQ(scene["force_on_drum"].size(), 3u);                // of each step, for the picture of the largest
  EXPECT_EQ(scene["force_on_drum"][1], (std::vector<double>{25.0, 400.0}));
  EXPECT_NEAR(scene["soil_bounds"][1][1].get<double>(), 2.0, 1e-6);
}

// Ball 1 on the left presses on ball 2 on the right through a periodic side.
TEST_F(VtkCommand, JoinsABallToTheImageOfAnother) {
  put("run/dump/contacts_200.dump", contact_dump("1 2 50 0 0 1 0 0 0.2\n"));
  well(run({"run", "--cell", "4"}));
  vtkNew<vtkXMLPolyDataReader> lines;
  lines->SetFileName((folder_ / "run/vtk/contacts_200.vtp").c_str());
  lines->Update();
  ASSERT_EQ(lines->GetOutput()->GetNumberOfLines(), 1);
  EXPECT_NEAR(lines->GetOutput()->GetPoint(0)[0], 1.0, 1e-6);
  EXPECT_NEAR(lines->GetOutput()->GetPoint(1)[0], 1.0 - 1.8, 1e-6);
  EXPECT_DOUBLE_EQ(lines->GetOutput()->GetCellData()->GetArray("normal_force")->GetTuple1(0), 50.0);
  vtkNew<vtkXMLImageDataReader> image;
  image->SetFileName((folder_ / "run/vtk/fields_200.vti").c_str());
  image->Update();
  EXPECT_NEAR(image->GetOutput()->GetCellData()->GetArray("stress")->GetComponent(0, 0),
              50.0 * 1.8 / (3.8 * 2.0), 1e-5);
}

TEST_F(VtkCommand, MakesDoWithoutContacts) {
  well(run({"run"}));
  for (const char *step : {"0", "1000", "200"})
    fs::remove(folder_ / "run/dump" / (std::string("contacts_") + step + ".dump"));
  EXPECT_TRUE(printed(well(run({"run"})), "no contacts and no fields"));
  EXPECT_EQ(names("run/vtk"), (std::vector<std::string>{"balls.pvd", "balls_0.vtp", "balls_1000.vtp",
                                                        "balls_200.vtp", "scene.json"}));
  EXPECT_FALSE(contains(read_text(folder_ / "run/vtk/balls_0.vtp"), "coordination"));
}

TEST_F(VtkCommand, ReplacesAnEarlierResultAndNothingElse) {
  well(run({"run"}));
  put("run/vtk/view.pvsm", "the user's");
  fs::remove(folder_ / "run/dump/balls_1000.vtp");
  well(run({"run"}));
  EXPECT_EQ(names("run/vtk"),
            (std::vector<std::string>{"balls.pvd", "balls_0.vtp", "balls_200.vtp", "contacts.pvd",
                                      "contacts_0.vtp", "contacts_200.vtp", "fields.pvd", "fields_0.vti",
                                      "fields_200.vti", "scene.json", "view.pvsm"}));
}

// The dumps have the names of the results; a file of the results may be a dump under another name.
TEST_F(VtkCommand, DoesNotReplaceTheDumps) {
  put("run/dump/balls.pvd", "of an earlier result");
  put("new/balls.pvd", "of an earlier result");
  fs::create_hard_link(folder_ / "run/dump/contacts_0.dump", folder_ / "new/scene.json");
  const auto before = files("run");
  for (const auto &[out, says] :
       {std::pair{"run/dump",
                  "--out is 'run/dump/balls_0.vtp'; allowed: another file than DIR 'run/dump/balls_0.vtp'"},
        {"new", "--out is 'new/scene.json'; allowed: another file than DIR 'run/dump/contacts_0.dump', which "
                "is read"}}) {
    const Outcome outcome = run({"run", "--out", out});
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_TRUE(printed(outcome, std::string("ERROR: drumlin vtk: ") + says));
    EXPECT_EQ(files("run"), before);
    EXPECT_EQ(names("new"), (std::vector<std::string>{"balls.pvd", "scene.json"}));
  }
}

struct Bad {
  std::string name;
  std::map<std::string, std::string> files; ///< replaced in the folder of the run; removed if "-"
  std::vector<std::string> says;
  std::vector<std::string> words = {"run"}; ///< of the call, after vtk
  int skipped = 0;                          ///< lines on steps that are left out, before the error
};

// Longer than other tests: it has a line for each mistake.
TEST_F(VtkCommand, BadInputIsOneLineAndTouchesNothing) {
  well(run({"run"}));
  const std::string balls = "dump/balls_200.vtp", contacts = "dump/contacts_200.dump";
  const auto with = [](std::map<std::string, Array> arrays, const std::string &name, const Array &array) {
    arrays[name] = array;
    return arrays;
  };
  const auto without = [](std::map<std::string, Array> arrays, const std::string &name) {
    arrays.erase(name);
    return arrays;
  };
  const std::string text_head = "ITEM: TIMESTEP\n300\nITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS ";
  put("file", "not a folder");
  const std::vector<Bad> table = {
      {"no folder", {}, {"dir is required"}, {}},
      {"unknown folder", {}, {"'nowhere'", "dump/balls_STEP.vtp", "allowed"}, {"nowhere"}},
      {"no dumps",
       {{"dump/balls_0.vtp", "-"}, {"dump/balls_200.vtp", "-"}, {"dump/balls_1000.vtp", "-"}},
       {"'run'", "dump/balls_STEP.vtp"}},
      {"no parameters", {{"parameters.csv", "-"}}, {"parameters.csv", "cannot be read"}},
      {"no time step", {{"parameters.csv", "name,value\nk,1\n"}}, {"parameters.csv", "timestep"}},
      {"time step of words", {{"parameters.csv", "name,value\ntimestep,soon\n"}}, {"'soon'", "> 0"}},
      {"time step of zero", {{"parameters.csv", "name,value\ntimestep,0\n"}}, {"'0'", "> 0"}},
      {"endless time step", {{"parameters.csv", "name,value\ntimestep,inf\n"}}, {"'inf'", "> 0"}},
      {"angular frequency of words",
       {{"parameters.csv", "name,value\ntimestep,1\nomega,fast\n"}},
       {"omega is 'fast'", "> 0"}},
      {"negative amplitude",
       {{"parameters.csv", "name,value\ntimestep,1\nomega,1\nFw,-1\n"}},
       {"Fw is '-1'", ">= 0"}},
      {"cell of zero", {}, {"--cell", "'0'", "from 1e-09"}, {"run", "--cell", "0"}},
      {"negative cell", {}, {"--cell", "'-1'", "from 1e-09"}, {"run", "--cell=-1"}},
      {"cell of words", {}, {"--cell", "'big'", "a number"}, {"run", "--cell", "big"}},
      {"empty cell", {}, {"--cell", "''", "a number"}, {"run", "--cell", ""}},
      {"absurd cell", {}, {"--cell", "'1e300'", "a number"}, {"run", "--cell", "1e300"}},
      {"empty out", {}, {"--out", "''", "allowed"}, {"run", "--out", ""}},
      {"too many cells", {}, {"--cell", "larger cells"}, {"run", "--cell", "1e-5"}},
      {"out is a file", {}, {"--out", "'file'", "allowed"}, {"run", "--out", "file"}},
      {"out below a file", {}, {"--out", "'file/x'", "allowed"}, {"run", "--out", "file/x"}},
      {"out is the dumps", {}, {"--out", "'run/dump'", "balls.pvd", "allowed"}, {"run", "--out", "run/dump"}},
      {"text dump of words", {{"dump/balls_300.dump", "hello"}}, {"balls_300.dump", "no text dump"}},
      {"text dump with a short row",
       {{"dump/balls_300.dump", text_head + "id type\n1 1\n2\n"}},
       {"balls_300.dump", "row 2 has 1 numbers; allowed: 2"}},
      {"text dump with a word",
       {{"dump/balls_300.dump", text_head + "id type\n1 soil\n2 1\n"}},
       {"balls_300.dump", "a number is 'soil'; allowed: "}},
      {"text dump that is not finite",
       {{"dump/balls_300.dump", text_head + "id type\n1 1\n2 nan\n"}},
       {"balls_300.dump", "'type' holds nan"}},
      {"text dump without radius",
       {{"dump/balls_300.dump", text_head + "id type\n1 1\n2 1\n"}},
       {"balls_300.dump", "column 'radius' is missing"}},
      {"text dump of two steps",
       {{"dump/balls_300.dump", text_head + "id type\n1 1\n2 1\n" + text_head + "id type\n1 1\n2 1\n"}},
       {"balls_300.dump", "more than one step"}},
      {"all balls cut short",
       {{"dump/balls_0.vtp", ""}, {balls, ""}, {"dump/balls_1000.vtp", "<?xml"}},
       {"cut short"},
       {"run"},
       3},
      {"balls of words", {{balls, "hello"}}, {"balls_200.vtp", "no whole VTK file"}},
      {"no balls", {{balls, point_data(0, "", {})}}, {"balls_200.vtp", "no balls"}},
      {"points without data", {{balls, point_data(1, "0 0 0", {})}}, {"balls_200.vtp", "'id'"}},
      {"no radius", {{balls, ball_dump(without(ball_arrays(), "radius"))}}, {"balls_200.vtp", "'radius'"}},
      {"flat velocity",
       {{balls, ball_dump(with(ball_arrays(), "v", {"v", 1, "1 2 3"}))}},
       {"balls_200.vtp", "'v'"}},
      {"radius of zero",
       {{balls, ball_dump(with(ball_arrays(), "radius", {"radius", 1, "2 0 1"}))}},
       {"ball 2", "> 0"}},
      {"mass of nan",
       {{balls, ball_dump(with(ball_arrays(), "mass", {"mass", 1, "2 nan 1"}))}},
       {"'mass'", "nan"}},
      {"an id twice",
       {{balls, ball_dump(with(ball_arrays(), "id", {"id", 1, "9 1 1"}))}},
       {"two balls", "1"}},
      {"no soil",
       {{balls, ball_dump(with(ball_arrays(), "type", {"type", 1, "2 3 3"}))}},
       {"balls_200.vtp", "no soil"}},
      {"contacts of words", {{contacts, "hello"}}, {"contacts_200.dump", "no text dump"}},
      {"contacts of another fix",
       {{contacts, std::regex_replace(contact_dump(), std::regex("f_contacts"), "f_mine")}},
       {"contacts_200.dump", "'f_contacts[1]'"}},
      {"contact of a stranger",
       {{contacts, contact_dump("7 1 1 0 0 1 0 0 0.1\n")}},
       {"contacts_200.dump", "ball 7"}},
      {"a stranger on the floor",
       {{contacts, contact_dump("7 0 0 1 0 0 1 0 0.1\n")}},
       {"contacts_200.dump", "ball 7"}},
      {"a contact twice",
       {{contacts, contact_dump("2 1 1 0 0 1 0 0 0.1\n1 2 -1 0 0 -1 0 0 0.1\n")}},
       {"contacts_200.dump", "1 and 2", "twice"}},
  };
  const auto before = files("run/vtk");
  ASSERT_EQ(before.size(), 13U);
  for (const Bad &bad : table) {
    SCOPED_TRACE(bad.name);
    std::map<std::string, std::string> saved;
    for (const auto &[file, text] : bad.files) {
      saved[file] = fs::exists(folder_ / "run" / file) ? read_text(folder_ / "run" / file) : "-";
      if (text == "-")
        fs::remove(folder_ / "run" / file);
      else
        put("run/" + file, text);
    }
    const Outcome outcome = run(bad.words);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    expect_one_error(outcome.output, "drumlin vtk: ");
    const std::vector<std::string> lines = lines_of(outcome.output);
    EXPECT_EQ(
        std::count_if(lines.begin(), lines.end(),
                      [](const std::string &line) { return line.find("steps read") == std::string::npos; }),
        1 + bad.skipped)
        << outcome.output;
    EXPECT_TRUE(printed(outcome, bad.says));
    EXPECT_EQ(files("run/vtk"), before);
    for (const auto &[file, text] : saved)
      if (text == "-")
        fs::remove(folder_ / "run" / file);
      else
        put("run/" + file, text);
  }
  well(run({"run"})); // all is as it was
}

// A run that was stopped leaves its last dumps cut short; the other steps are shown, and one line names each
// that is not.
TEST_F(VtkCommand, LeavesOutWhatWasCutShortAndSaysSo) {
  const std::string whole = ball_dump();
  const std::string text_dump = "ITEM: TIMESTEP\n400\nITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS id type\n1 1\n";
  struct Cut {
    const char *file;
    std::string text;
    const char *says;
    std::size_t balls, contacts; // steps that are left
  };
  const std::vector<Cut> table = {
      {"run/dump/balls_1000.vtp", "", "step 1000 left out: run/dump/balls_1000.vtp: is cut short", 2, 2},
      {"run/dump/balls_1000.vtp", whole.substr(0, whole.size() / 2), "step 1000 left out: ", 2, 2},
      {"run/dump/balls_400.dump", text_dump, "balls_400.dump: is cut short: it has 1 rows; allowed: 2", 3, 3},
      {"run/dump/balls_400.dump", text_dump + "2 1", "it has 1 rows; allowed: 2", 3, 3}, // 12, perhaps
      {"run/dump/balls_400.dump", text_dump.substr(0, 30), "it ends before its rows begin", 3, 3},
      {"run/dump/balls_400.dump", "", "it ends before its rows begin", 3, 3},
      {"run/dump/contacts_200.dump", contact_dump().substr(0, contact_dump().size() - 24),
       "contacts of step 200 left out: run/dump/contacts_200.dump: is cut short", 3, 2},
  };
  for (const Cut &cut : table) {
    SCOPED_TRACE(cut.says);
    const fs::path file = folder_ / cut.file;
    const std::string saved = fs::exists(file) ? read_text(file) : "-";
    put(cut.file, cut.text);
    const Outcome outcome = run({"run"});
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_TRUE(printed(outcome, {cut.says, fmt::format("balls.pvd: {} steps", cut.balls),
                                  fmt::format("contacts.pvd: {} steps", cut.contacts)}));
    if (saved == "-")
      fs::remove(file);
    else
      put(cut.file, saved);
  }
}

TEST_F(VtkCommand, NamesMissingSteps) {
  EXPECT_TRUE(
      run({"run"}).says("3 steps of the dumps every 200 are missing, from step 400 on")); // 0, 200, 1000
  put("run/dump/balls_500.vtp", ball_dump());
  EXPECT_FALSE(run({"run"}).says("missing, from")); // 0, 200, 500, 1000: not at equal distances
}

// Debian 12's ParaView cannot read VTK's appended data: the arrays are in the XML.
TEST_F(VtkCommand, WritesNoAppendedData) {
  well(run({"run"}));
  for (const char *name : {"run/vtk/balls_0.vtp", "run/vtk/contacts_0.vtp", "run/vtk/fields_0.vti"}) {
    const std::string text = read_text(folder_ / name);
    EXPECT_FALSE(contains(text, "<AppendedData")) << name;
    EXPECT_TRUE(contains(text, "format=\"binary\"")) << name;
  }
}

// A first call that fails leaves no folder.
TEST_F(VtkCommand, TakesHostileNames) {
  for (const char *name : {"100%", "%s%n", "a\"b", "it's", "{}", "b\\n", "x y", "$(touch pwned)",
                           "x;touch pwned;", "-x", "B[1]", "run(1)", "A&B", "bad\xff"}) {
    const fs::path run_folder = folder_ / "hostile" / name;
    fs::create_directories(run_folder.parent_path());
    fs::copy(folder_ / "run", run_folder, fs::copy_options::recursive);
    const Outcome outcome = run({"--", "hostile/" + std::string(name)});
    EXPECT_TRUE(outcome.ok()) << name << ": " << outcome.output;
    EXPECT_TRUE(fs::is_regular_file(run_folder / "vtk" / "balls.pvd")) << name;
  }
  fs::copy(folder_ / "run", folder_ / "-x", fs::copy_options::recursive);
  well(run({"--", "-x"}));
  EXPECT_TRUE(fs::is_regular_file(folder_ / "-x" / "vtk" / "balls.pvd"));
  EXPECT_FALSE(fs::exists(folder_ / "pwned"));
}

TEST_F(VtkCommand, ClearsAwayWhatAKilledCallLeft) {
  const std::string killed = "run/vtk/unfinished.123", other = "run/vtk/unfinished.work";
  put(killed + "/balls_0.vtp", "half a file");
  put(other + "/balls_0.vtp", "half a file");
  well(run({"run"}));
  EXPECT_FALSE(fs::exists(folder_ / killed));
  EXPECT_TRUE(fs::exists(folder_ / other));
  const post::TemporaryFolder running(folder_ / "run/vtk", "unfinished.");
  const Outcome second = run({"run"});
  EXPECT_EQ(second.status, 2);
  EXPECT_TRUE(printed(second, "vtk', into which another call writes; allowed: another folder"));
}

TEST_F(VtkCommand, AFailureLeavesNothingBehind) {
  put("run/dump/contacts_1000.dump", "hello");
  EXPECT_EQ(run({"run"}).status, 2);
  EXPECT_FALSE(fs::exists(folder_ / "run/vtk"));
}

} // namespace
} // namespace drumlin::test

#include "files.hpp"
#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"
#include "model/model_block.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace
{

using namespace frontalis;
namespace fs = std::filesystem;

class ModelFile : public testing::Test
{
protected:
  std::string path(const std::string& name) const { return folder_ / name; }

  static std::string fault_of(const std::string& file)
  {
    try
    {
      read_model(file);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(ModelFile, GivesBackEveryField)
{
  const Model a = full_block(3, 4, 5);
  write_model(a, path("a.vtkhdf"));
  const Model b = read_model(path("a.vtkhdf"));
  EXPECT_EQ(a.spacing, b.spacing);
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.voxels, b.voxels);
  EXPECT_EQ(a.fill, b.fill);
  EXPECT_EQ(a.mixture_begin, b.mixture_begin);
  EXPECT_EQ(a.mixture_material, b.mixture_material);
  EXPECT_EQ(a.mixture_proportion, b.mixture_proportion);
  EXPECT_EQ(a.material_directions, b.material_directions);
  EXPECT_EQ(a.fibre_begin, b.fibre_begin);
  EXPECT_EQ(a.fibre_weight, b.fibre_weight);
  EXPECT_EQ(a.fibre_direction, b.fibre_direction);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.voxel_nodes, b.voxel_nodes);
  ASSERT_EQ(b.materials.size(), 2u);
  EXPECT_EQ(b.materials[1].name, "a muscle");
  EXPECT_EQ(a.materials[1].parameters, b.materials[1].parameters);
  EXPECT_EQ(b.materials[0].density, 1000);
  ASSERT_EQ(b.muscles.size(), 1u);
  EXPECT_EQ(b.muscles[0].name, "frontalis_left");
  EXPECT_EQ(b.muscles[0].stress_reference, 5e6);
  EXPECT_TRUE(b.muscles[0].passive);
  EXPECT_FALSE(b.muscles[0].tension_length);
  EXPECT_EQ(b.muscles[0].rise_time, 0.01);
  EXPECT_EQ(b.muscles[0].fall_time, 0.03);
  EXPECT_EQ(a.materials[1].viscous_share, b.materials[1].viscous_share);
  EXPECT_EQ(a.materials[1].viscous_time, b.materials[1].viscous_time);
  EXPECT_EQ(b.hourglass, HourglassControl::assumed_strain);
  EXPECT_EQ(b.integration, Integration::selective_reduced);
  EXPECT_EQ(b.precision, Precision::compensated);
  EXPECT_EQ(b.time_step_estimate, TimeStepEstimate::assembled);
  EXPECT_EQ(a.bones, b.bones);
  ASSERT_EQ(b.constraint_surfaces.size(), 1u);
  const SampledField &a_field = a.constraint_surfaces[0].field, &b_field = b.constraint_surfaces[0].field;
  EXPECT_EQ(a_field.origin, b_field.origin);
  EXPECT_EQ(a_field.spacing, b_field.spacing);
  EXPECT_EQ(a_field.radius, b_field.radius);
  EXPECT_EQ(a_field.bricks, b_field.bricks);
  EXPECT_EQ(a_field.table, b_field.table);
  EXPECT_EQ(a_field.samples, b_field.samples);
  EXPECT_FALSE(b_field.samples.empty());
  EXPECT_EQ(b.constraint_surfaces[0].bone, 1);
  EXPECT_EQ(b.constraint_surfaces[0].friction, 0.25);
  ASSERT_EQ(b.rigid.size(), 2u);
  EXPECT_EQ(b.rigid[1].bone, 1);
  ASSERT_EQ(b.sliding.size(), 1u);
  EXPECT_EQ(b.sliding[0].distance, -0.00125);
  ASSERT_EQ(b.attached.size(), 2u);
  EXPECT_EQ(b.attached[0].master, 5);
  EXPECT_EQ(b.attached[0].bone, 1);
  EXPECT_EQ(b.attached[1].ratio, 0.5);
  EXPECT_EQ(b.attached[1].surface, 0);
  EXPECT_EQ(a.tissue_centre, b.tissue_centre);
  EXPECT_FALSE(b.tissue_centre.empty());
  EXPECT_EQ(a.gravity, b.gravity);
  ASSERT_EQ(b.loads.size(), 2u);
  EXPECT_EQ(b.loads[0].kind, Load::Kind::pressure);
  EXPECT_EQ(a.loads[0].fixed, b.loads[0].fixed);
  EXPECT_EQ(a.loads[0].binding.coordinates, b.loads[0].binding.coordinates);
  EXPECT_EQ(b.loads[1].name, "push");
  EXPECT_EQ(b.prescribed.at(0).load, 1);
  EXPECT_EQ(a.skin.triangles, b.skin.triangles);
  EXPECT_EQ(a.skin_binding.coordinates, b.skin_binding.coordinates);
  EXPECT_EQ(a.landmarks, b.landmarks);
  EXPECT_EQ(a.landmark_positions, b.landmark_positions);
  EXPECT_EQ(a.to_scene.rotation, b.to_scene.rotation);
  EXPECT_EQ(a.to_face.translation, b.to_face.translation);
  EXPECT_EQ(b.face_frame, "face_one");
  EXPECT_EQ(b.damping, 20);
  EXPECT_EQ(b.time_step_share, 0.8);
  EXPECT_EQ(b.activation_slew, 8);
  EXPECT_EQ(b.mass_scaling.kind, MassScalingSettings::Kind::selective);
  EXPECT_EQ(b.mass_scaling.time_step, 2e-5);
  EXPECT_EQ(b.mass_scaling.in_motion, 3e-5);
  EXPECT_EQ(a.mass_scaling.materials, b.mass_scaling.materials);
  ASSERT_EQ(b.expressions.size(), 2u);
  EXPECT_EQ(a.expressions[0].activation, b.expressions[0].activation);
  EXPECT_TRUE(b.expressions[1].activation.empty());
  EXPECT_TRUE(b.expressions[0].bones.empty());
  EXPECT_EQ(b.muscles[0].tone, 0.125);
  ASSERT_EQ(b.action_units.size(), 1u);
  EXPECT_EQ(b.action_units[0].name, "AU1");
  EXPECT_EQ(a.action_units[0].activation, b.action_units[0].activation);
  ASSERT_EQ(b.action_units[0].bones.size(), 1u);
  EXPECT_EQ(b.action_units[0].bones[0].bone, 1);
  EXPECT_EQ(b.action_units[0].bones[0].centre[0], -80e-3);
  ASSERT_EQ(b.demo.size(), 2u);
  EXPECT_EQ(b.demo[1].expression, -1);
  EXPECT_TRUE(b.demo[0].bones.empty());
  ASSERT_EQ(b.demo[1].bones.size(), 1u);
  EXPECT_EQ(b.demo[1].bones[0].bone, 1);
  EXPECT_EQ(b.demo[1].bones[0].shift[0], 1e-3);
  EXPECT_EQ(b.demo[1].bones[0].turn[1], 0.1);
  ASSERT_EQ(b.profiles.size(), 2u);
  EXPECT_EQ(b.profiles[0].error, 0.3e-3);
  EXPECT_EQ(b.profiles[0].machine, "a bench");
  EXPECT_EQ(b.profiles[1].cost, 0);
  EXPECT_EQ(b.profile, "draft");
  EXPECT_EQ(b.scene_hash, a.scene_hash);
}

TEST_F(ModelFile, EqualModelsGiveEqualBytes)
{
  write_model(full_block(3, 4, 5), path("a.vtkhdf"));
  ::sleep(2);  // longer than the resolution of HDF5's time stamps
  write_model(full_block(3, 4, 5), path("b.vtkhdf"));
  EXPECT_TRUE(text_of(path("a.vtkhdf")) == text_of(path("b.vtkhdf")));
  Model other = full_block(3, 4, 5);
  other.scene_hash = "fedcba9876543210";
  write_model(other, path("c.vtkhdf"));
  EXPECT_FALSE(text_of(path("a.vtkhdf")) == text_of(path("c.vtkhdf")));
}

TEST_F(ModelFile, MissingFolderAndForeignFilesAreNamed)
{
  EXPECT_NE(fault_of(path("none.vtkhdf")).find("no such file"), std::string::npos);
  EXPECT_NE(fault_of(path("none.vtkhdf")).find(path("none.vtkhdf")), std::string::npos);
  EXPECT_NE(fault_of(folder_.path()).find("folder"), std::string::npos);
  std::ofstream(path("text.vtkhdf")) << "voxels: none\n";
  EXPECT_NE(fault_of(path("text.vtkhdf")).find("not an HDF5 file"), std::string::npos);
}

TEST_F(ModelFile, TruncatedFilesAreRefusedAtEveryLength)
{
  write_model(full_block(3, 4, 5), path("a.vtkhdf"));
  const auto size = fs::file_size(path("a.vtkhdf"));
  for (int part = 0; part < 16; ++part)
  {
    const std::string cut = path("cut" + std::to_string(part) + ".vtkhdf");
    fs::copy_file(path("a.vtkhdf"), cut);
    fs::resize_file(cut, part == 15 ? size - 1 : size * static_cast<unsigned>(part) / 16);
    const std::string fault = fault_of(cut);
    EXPECT_NE(fault.find(part == 0 ? "not an HDF5 file" : "truncated"), std::string::npos) << part << ": " << fault;
  }
}

TEST_F(ModelFile, ADamagedValueIsFound)
{
  Model model = full_block(3, 2, 2);
  const float fill[] = { 0.8125F, 0.4375F, 0.3125F };
  std::copy(std::begin(fill), std::end(fill), model.fill.begin());
  write_model(model, path("a.vtkhdf"));
  const std::string numbers(reinterpret_cast<const char*>(fill), sizeof fill);
  for (const auto& [array, bytes] :
       { std::pair{ "fill", numbers }, std::pair{ "materials/name", model.materials[1].name } })
  {
    std::string content = text_of(path("a.vtkhdf"));
    // The arrays for ParaView have the same numbers.
    std::size_t found = 0;
    for (std::size_t at = content.find(bytes); at != std::string::npos; at = content.find(bytes, at + 1), ++found)
      content[at + 1] ^= 4;
    ASSERT_GT(found, 0u);
    std::ofstream(path("b.vtkhdf"), std::ios::binary) << content;
    const std::string fault = fault_of(path("b.vtkhdf"));
    EXPECT_NE(fault.find(std::string(array) + " cannot be read; the file is truncated or damaged"), std::string::npos)
        << fault;
  }
}

TEST_F(ModelFile, AnotherVersionIsRefusedWithBothNumbers)
{
  write_model(full_block(2, 2, 2), path("a.vtkhdf"));
  std::string content = text_of(path("a.vtkhdf"));
  // Bytes of the attribute: name padded to 24 bytes, type (16), shape of a scalar (8), value.
  const std::size_t name = content.find("model_file_version");
  ASSERT_NE(name, std::string::npos);
  const std::size_t at = name + 24 + 16 + 8;
  ASSERT_EQ(content[at], model_file_version);
  content[at] = 77;
  std::ofstream(path("b.vtkhdf"), std::ios::binary) << content;
  const std::string fault = fault_of(path("b.vtkhdf"));
  EXPECT_NE(fault.find("version 77"), std::string::npos) << fault;
  EXPECT_NE(fault.find("reads version " + std::to_string(model_file_version)), std::string::npos) << fault;
}

TEST_F(ModelFile, AnotherSceneOrPackageIsRefusedWhereOneIsAskedFor)
{
  Model model = full_block(2, 2, 2);
  model.scene_hash = "0123456789abcdef";
  write_model(model, path("a.vtkhdf"));
  EXPECT_EQ(read_model_of(path("a.vtkhdf"), "0123456789abcdef").voxels.size(), 8u);
  const auto fault = [&](const std::string& hash)
  {
    try
    {
      read_model_of(path("a.vtkhdf"), hash);
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string other = fault("fedcba9876543210");
  EXPECT_NE(other.find("is of another scene"), std::string::npos) << other;
  EXPECT_NE(other.find("fedcba9876543210"), std::string::npos) << other;
  const Model again = read_model(path("a.vtkhdf"));
  EXPECT_EQ(again.scene_hash, model.scene_hash);
  // The file contains the version of the package as text. Its first digit is changed.
  std::string version = FRONTALIS_VERSION;
  version[0] = '9';
  const hid_t file = H5Fopen(path("a.vtkhdf").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t text = H5Dopen2(file, "/frontalis/package_version", H5P_DEFAULT), type = H5Dget_type(text);
  ASSERT_EQ(H5Tget_size(type), version.size());
  EXPECT_GE(H5Dwrite(text, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, version.data()), 0);
  H5Tclose(type);
  H5Dclose(text);
  H5Fclose(file);
  const std::string foreign = fault("0123456789abcdef");
  EXPECT_NE(foreign.find("was baked by version 9"), std::string::npos) << foreign;
}

TEST_F(ModelFile, NothingIsLeftWhenWritingFails)
{
  Model bad = full_block(2, 2, 2);
  bad.fill.pop_back();
  EXPECT_THROW(write_model(bad, path("bad.vtkhdf")), Error);
  EXPECT_THROW(write_model(full_block(2, 2, 2), path("no_folder/a.vtkhdf")), Error);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  // An existing file stays intact if writing its successor fails.
  write_model(full_block(2, 2, 2), path("a.vtkhdf"));
  const std::string before = text_of(path("a.vtkhdf"));
  EXPECT_THROW(write_model(bad, path("a.vtkhdf")), Error);
  EXPECT_TRUE(before == text_of(path("a.vtkhdf")));
}

TEST_F(ModelFile, LinksStayAndWhatIsNoRegularFileIsNotReplaced)
{
  const Model model = full_block(1, 1, 1);
  write_model(model, path("model.vtkhdf"));
  fs::create_symlink("model.vtkhdf", path("link.vtkhdf"));
  write_model(full_block(2, 1, 1), path("link.vtkhdf"));
  EXPECT_TRUE(fs::is_symlink(path("link.vtkhdf")));
  EXPECT_EQ(read_model(path("model.vtkhdf")).voxels.size(), 2u);
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_THROW(write_model(model, path("pipe")), Error);
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
}

TEST_F(ModelFile, AMillionVoxelsAreReadBack)
{
  const Model model = full_block(100, 100, 100);
  write_model(model, path("million.vtkhdf"));
  const Model back = read_model(path("million.vtkhdf"));
  ASSERT_EQ(back.voxels.size(), 1000000u);
  EXPECT_TRUE(back.voxels == model.voxels);
}

}  // namespace

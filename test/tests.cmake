# Unit, physics and ROS tests; included by the package's CMakeLists.txt.
find_package(roslaunch REQUIRED)
find_package(rostest REQUIRED)

# A GoogleTest binary of all the files test/<folder>/*_test.cpp.
function(add_test_folder folder)
  file(GLOB sources CONFIGURE_DEPENDS test/${folder}/*_test.cpp)
  catkin_add_gtest(${folder}_test ${sources})
  target_include_directories(${folder}_test PRIVATE test src/${folder})
  target_link_libraries(${folder}_test ${PROJECT_NAME}_config gtest_main)
  target_compile_definitions(${folder}_test PRIVATE
    VACUUM_GRIPPER_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    VACUUM_GRIPPER_EXPERIMENT="$<TARGET_FILE:vacuum_gripper_experiment>")
  target_compile_options(${folder}_test PRIVATE ${strict_warnings})
  add_dependencies(${folder}_test vacuum_gripper_experiment)
endfunction()

add_test_folder(core)
add_test_folder(config)
add_test_folder(physics)
add_test_folder(validation)
# A program of its own: it counts every allocation.
add_test_folder(allocation)
target_sources(allocation_test PRIVATE test/allocation/counter.cpp)

# The parts of the node that need no graph.
catkin_add_gtest(node_parts_test test/ros/actuator_test.cpp test/ros/core_follower_test.cpp
  test/ros/loop_priority_test.cpp test/ros/outbox_test.cpp
  test/ros/step_schedule_test.cpp test/ros/step_times_test.cpp src/ros/actuator.cpp
  src/ros/core_follower.cpp src/ros/loop_priority.cpp src/ros/step_schedule.cpp
  src/ros/step_times.cpp)
target_include_directories(node_parts_test PRIVATE src/ros)
target_include_directories(node_parts_test SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
target_link_libraries(node_parts_test Eigen3::Eigen ${catkin_LIBRARIES} gtest_main)
target_compile_options(node_parts_test PRIVATE ${strict_warnings})

file(GLOB rostests CONFIGURE_DEPENDS test/ros/*.test)
foreach(rostest ${rostests})
  add_rostest(${rostest} DEPENDENCIES vacuum_gripper_node)
endforeach()
roslaunch_add_file_check(launch)

"""Which file a frame shows."""

import pytest

from meniscus_blender.sequence import MissingFile, SequenceError, Timing, files, gaps_text, path_of, pattern_of, span


def make(folder, *names):
    for name in names:
        (folder / name).touch()
    return folder


def test_the_number_by_which_the_names_differ_is_the_frame(tmp_path):
    make(tmp_path, "dam_2_frame_10_of_500.vtk", "dam_2_frame_20_of_500.vtk", "dam_3_frame_10_of_500.ply")
    assert pattern_of(tmp_path / "dam_2_frame_10_of_500.vtk") == str(tmp_path / "dam_2_frame_{}_of_500.vtk")


def test_of_two_numbers_the_last_is_the_frame(tmp_path):
    make(tmp_path, "run1_1.vtk", "run1_2.vtk", "run2_1.vtk")
    assert pattern_of(tmp_path / "run1_1.vtk") == str(tmp_path / "run1_{}.vtk")


def test_a_file_without_others_is_no_sequence(tmp_path):
    make(tmp_path, "water_0001.bgeo.gz", "water.vtk")
    assert pattern_of(tmp_path / "water_0001.bgeo.gz") == str(tmp_path / "water_0001.bgeo.gz")
    assert pattern_of(tmp_path / "water.vtk") == str(tmp_path / "water.vtk")


def test_numbers_have_any_digits(tmp_path):
    make(tmp_path, "f9.vtk", "f10.vtk", "f0011.vtk", "f.vtk", "fx.vtk", "f12.vtk.part", "f\u0663.vtk")
    assert sorted(files(str(tmp_path / "f{}.vtk"))) == [9, 10, 11]
    assert path_of(str(tmp_path / "f{}.vtk"), 11) == str(tmp_path / "f0011.vtk")


def test_of_two_files_with_one_number_it_is_always_the_same(tmp_path):
    make(tmp_path, "f7.vtk", "f007.vtk")
    assert files(str(tmp_path / "f{}.vtk")) == {7: str(tmp_path / "f7.vtk")}


def test_a_file_that_is_missing_is_named(tmp_path):
    make(tmp_path, "f1.vtk", "f3.vtk")
    with pytest.raises(SequenceError, match="no file with the number 2; there are 2, from 1 to 3"):
        path_of(str(tmp_path / "f{}.vtk"), 2)
    with pytest.raises(SequenceError, match="f4.vtk is not there"):
        path_of(str(tmp_path / "f4.vtk"), 0)
    with pytest.raises(SequenceError, match="nowhere: No such file"):
        path_of(str(tmp_path / "nowhere" / "f{}.vtk"), 0)
    with pytest.raises(SequenceError, match="needs one {}"):
        path_of(str(tmp_path / "f{}_{}.vtk"), 0)


def test_gaps_are_told_in_one_sentence(tmp_path):
    assert gaps_text([1, 2, 3]) == gaps_text([5]) == gaps_text([20, 40, 60]) == ""
    assert gaps_text([20, 30, 60]) == "2 of the numbers 20 to 60 by 10 have no file: 40, 50"
    assert gaps_text([1, 2, 258]) == "255 of the numbers 1 to 258 have no file: 3, 4, 5, 6, 7, 8, 9, 10, ..."
    make(tmp_path, "f1.vtk", "f3.vtk")
    with pytest.raises(MissingFile):
        path_of(str(tmp_path / "f{}.vtk"), 2)


def test_the_stride_divides_all_distances():
    assert span([40, 20, 30, 70]) == (20, 70, 10)
    assert span([5]) == (5, 5, 1)
    assert span([1, 2, 4]) == (1, 4, 1)


def test_frames_before_and_after_hold_or_show_nothing():
    held = Timing(first=20, last=60, stride=20, start=5)
    assert [held.number(frame) for frame in (-3, 5, 6, 7, 100)] == [20, 20, 40, 60, 60]
    bare = Timing(first=20, last=60, stride=20, start=5, holds=False)
    assert [bare.number(frame) for frame in (4, 5, 7, 8)] == [None, 20, 60, None]


def test_the_speed_leaves_out_or_holds_files():
    fast = Timing(first=0, last=9, start=1, speed=2.0)
    assert [fast.number(frame) for frame in (1, 2, 3)] == [0, 2, 4]
    slow = Timing(first=0, last=9, start=1, speed=1 / 3)
    assert [slow.number(frame) for frame in range(1, 8)] == [0, 0, 0, 1, 1, 1, 2]
    assert slow.number(slow.end()) == 9 and slow.number(slow.end() - 1) == 8

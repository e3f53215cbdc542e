"""The table of targets: what is a fault."""

from tools.measure.targets import Row, faults

EASY, STRICT = Row("theta_deg", 10.0, 100, 0.99, 0.0), Row("theta_deg", 3.0, 200, 0.97, 0.0)


def test_a_table_has_no_faults_if_easier_targets_take_fewer_bytes_and_all_are_used() -> None:
    assert not [*faults([EASY, STRICT], [])]
    assert not [*faults([EASY, STRICT], [100, 199])]


def test_larger_files_unused_targets_and_easier_ones_with_more_bytes_are_faults() -> None:
    assert [*faults([EASY, STRICT], [90, 200])] == [f"{EASY} in place of 90"]
    unused = Row("theta_deg", 10.0, 201, 0.5, 0.0)
    assert len([*faults([unused, STRICT], [])]) == 2
    sized = Row("bpv", 4.0, 100, 0.99, 0.0), Row("bpv", 8.0, 50, 0.99, 0.0)
    assert not [*faults([*sized], [])]

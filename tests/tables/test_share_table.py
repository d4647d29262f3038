"""The shares of E_0 and the accounts over time stand in one list each."""

from fem_impact.answers.compare import UNSEEN
from fem_impact.answers.report import LEDGER
from fem_impact.evidence.studies.convergence import QUANTITIES
from fem_impact.figures.still import PALETTE
from fem_impact.outcome.record import KEYS
from fem_impact.outcome.shares import ACCOUNTS, SHARES, shares
from fem_impact.tables.history import HISTORY


def test_every_share_is_a_key_with_a_colour_and_is_shown():
    assert len({share.key.name for share in SHARES}) == len({share.label for share in SHARES}) == len(SHARES)
    for share in SHARES:
        assert share.key in KEYS and share.key.meaning
        assert share.colour in PALETTE and share.shown


def test_lists_of_shares_are_those_of_the_table():
    assert [q.key for q in UNSEEN] == [share.key for share in shares("comparison")]
    assert {share.key.name for share in shares("study")} <= set(LEDGER)
    assert {share.key for share in shares("study")} <= set(QUANTITIES.values())


def test_accounts_are_columns_of_the_history():
    assert {account.column for account in ACCOUNTS} <= set(HISTORY)
    assert {account.colour for account in ACCOUNTS} <= set(PALETTE)

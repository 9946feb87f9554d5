"""Write what pages have from the code: `make docs`."""

from tests.docs import (
    alarm_kinds,
    alarm_transitions,
    architecture_drawing,
    audit_actions,
    command_reference,
    quantities,
    role_tables,
)

architecture_drawing.main()
command_reference.main()
alarm_transitions.main()
alarm_kinds.main()
audit_actions.main()
role_tables.main()
quantities.main()
